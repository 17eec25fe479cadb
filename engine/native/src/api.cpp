// SPDX-License-Identifier: GPL-3.0-or-later
// The C interface: errors, the version and the device.
#include "api.h"

namespace {

std::string &last_error() {
    thread_local std::string message;
    return message;
}

}  // namespace

pm_status pm::fail(pm_status status, const char *message) noexcept {
    try {
        last_error() = message;
    } catch (const std::bad_alloc &) {
        last_error().clear();  // the code alone must do
    }
    return status;
}

uint32_t pm_abi_version(void) { return PM_ABI_VERSION; }

const char *pm_last_error(void) { return last_error().c_str(); }

pm_status pm_device_create(const char *embree_path, pm_device **device) {
    return pm::guarded([&] {
        pm::require_handle(embree_path, "embree_path");
        pm::require_handle(device, "device");
        *device = std::make_unique<pm_device>(pm_device{std::make_shared<const pm::Embree>(embree_path)}).release();
    });
}

pm_status pm_device_embree_version(const pm_device *device, uint32_t *version) {
    return pm::guarded([&] {
        pm::require_handle(device, "device");
        pm::require_handle(version, "version");
        *version = device->embree->version();
    });
}

void pm_device_release(pm_device *device) { const std::unique_ptr<pm_device> owned(device); }
