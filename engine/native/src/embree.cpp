// SPDX-License-Identifier: GPL-3.0-or-later
#include "embree.h"

#include <dlfcn.h>

#include <array>
#include <new>

#include "parallel.h"

namespace photon_maps {

namespace {

// Blender's executable puts its own Embree and TBB into the global scope; without RTLD_DEEPBIND the library would
// bind to them. The address sanitizer's runtime refuses that flag, and runs in no process with a second Embree.
// RTLD_NODELETE: TBB's threads sleep in the library's code after the last device is gone.
#if defined(RTLD_DEEPBIND) && !defined(__SANITIZE_ADDRESS__)
constexpr int load_flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE | RTLD_DEEPBIND;
#else
constexpr int load_flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;
#endif

template <class Function>
void resolve(void *library, const char *name, Function *&function) {
    function = reinterpret_cast<Function *>(dlsym(library, name));
    if (!function) throw EmbreeError(std::string("the Embree library has no function ") + name);
}

rtc::Functions resolve_functions(void *library) {
    rtc::Functions f{};
    resolve(library, "rtcNewDevice", f.rtcNewDevice);
    resolve(library, "rtcReleaseDevice", f.rtcReleaseDevice);
    resolve(library, "rtcGetDeviceProperty", f.rtcGetDeviceProperty);
    resolve(library, "rtcGetDeviceError", f.rtcGetDeviceError);
    resolve(library, "rtcNewScene", f.rtcNewScene);
    resolve(library, "rtcReleaseScene", f.rtcReleaseScene);
    resolve(library, "rtcSetSceneFlags", f.rtcSetSceneFlags);
    resolve(library, "rtcSetSceneBuildQuality", f.rtcSetSceneBuildQuality);
    resolve(library, "rtcSetSceneProgressMonitorFunction", f.rtcSetSceneProgressMonitorFunction);
    resolve(library, "rtcCommitScene", f.rtcCommitScene);
    resolve(library, "rtcNewGeometry", f.rtcNewGeometry);
    resolve(library, "rtcReleaseGeometry", f.rtcReleaseGeometry);
    resolve(library, "rtcCommitGeometry", f.rtcCommitGeometry);
    resolve(library, "rtcAttachGeometryByID", f.rtcAttachGeometryByID);
    resolve(library, "rtcSetSharedGeometryBuffer", f.rtcSetSharedGeometryBuffer);
    resolve(library, "rtcSetGeometryInstancedScene", f.rtcSetGeometryInstancedScene);
    resolve(library, "rtcSetGeometryMask", f.rtcSetGeometryMask);
    resolve(library, "rtcSetGeometryTransform", f.rtcSetGeometryTransform);
    resolve(library, "rtcIntersect1", f.rtcIntersect1);
    resolve(library, "rtcOccluded1", f.rtcOccluded1);
    return f;
}

constexpr int property_version = 0;  // RTC_DEVICE_PROPERTY_VERSION
constexpr int error_out_of_memory = 4, error_cancelled = 6;

}  // namespace

void Embree::LibraryCloser::operator()(void *library) const { dlclose(library); }

Embree::Embree(const std::string &path) : library_(dlopen(path.c_str(), load_flags)) {
    if (!library_) {
        const char *reason = dlerror();
        throw EmbreeError("Embree cannot be loaded: " + std::string(reason ? reason : path.c_str()));
    }
    functions_ = resolve_functions(library_.get());
    device_ = functions_.rtcNewDevice(nullptr);
    if (!device_) throw EmbreeError("Embree cannot be started on this processor");
    version_ = static_cast<uint32_t>(functions_.rtcGetDeviceProperty(device_, property_version));
    // The ray and hit structures above are those of 4.3 and later; another major version may differ in anything.
    if (version_ < 40300 || version_ >= 50000) {
        functions_.rtcReleaseDevice(device_);
        throw EmbreeError("Embree 4.3 or later of version 4 is needed, but version number " + std::to_string(version_) +
                          " was found at " + path);
    }
}

Embree::~Embree() { functions_.rtcReleaseDevice(device_); }

void Embree::check(const char *what) const {
    const int code = functions_.rtcGetDeviceError(device_);
    if (code == error_out_of_memory) throw std::bad_alloc();
    if (code == error_cancelled) throw Cancelled();
    constexpr std::array names{"none",          "unknown",        "invalid argument", "invalid operation",
                               "out of memory", "unsupported CPU"};
    if (code == 0) return;
    const auto known = static_cast<size_t>(code) < names.size();
    throw EmbreeError(std::string("Embree failed while ") + what + ": " +
                      (known ? names[static_cast<size_t>(code)] : "error " + std::to_string(code)));
}

}  // namespace photon_maps
