// SPDX-License-Identifier: GPL-3.0-or-later
#include "embree.h"

#include <algorithm>
#include <array>
#include <new>

#include "parallel.h"
#include "processor.h"

namespace photon_maps {

namespace {

rtc::Functions resolve_functions(const DynamicLibrary &library) {
    rtc::Functions f{};
    library.resolve("rtcNewDevice", f.rtcNewDevice);
    library.resolve("rtcReleaseDevice", f.rtcReleaseDevice);
    library.resolve("rtcGetDeviceProperty", f.rtcGetDeviceProperty);
    library.resolve("rtcGetDeviceError", f.rtcGetDeviceError);
    library.resolve("rtcNewScene", f.rtcNewScene);
    library.resolve("rtcReleaseScene", f.rtcReleaseScene);
    library.resolve("rtcSetSceneFlags", f.rtcSetSceneFlags);
    library.resolve("rtcSetSceneBuildQuality", f.rtcSetSceneBuildQuality);
    library.resolve("rtcSetSceneProgressMonitorFunction", f.rtcSetSceneProgressMonitorFunction);
    library.resolve("rtcCommitScene", f.rtcCommitScene);
    library.resolve("rtcJoinCommitScene", f.rtcJoinCommitScene);
    library.resolve("rtcNewGeometry", f.rtcNewGeometry);
    library.resolve("rtcReleaseGeometry", f.rtcReleaseGeometry);
    library.resolve("rtcCommitGeometry", f.rtcCommitGeometry);
    library.resolve("rtcAttachGeometryByID", f.rtcAttachGeometryByID);
    library.resolve("rtcSetSharedGeometryBuffer", f.rtcSetSharedGeometryBuffer);
    library.resolve("rtcSetGeometryInstancedScene", f.rtcSetGeometryInstancedScene);
    library.resolve("rtcSetGeometryMask", f.rtcSetGeometryMask);
    library.resolve("rtcSetGeometryTransform", f.rtcSetGeometryTransform);
    library.resolve("rtcIntersect1", f.rtcIntersect1);
    library.resolve("rtcOccluded1", f.rtcOccluded1);
    return f;
}

/// @throws EmbreeError where the processor lacks what this library was compiled for
void check_processor() {
#if defined(__x86_64__)
    if (!has_baseline) throw EmbreeError("this processor lacks SSE4.2, which Photon Maps needs");
#endif
}

constexpr int property_version = 0;  // RTC_DEVICE_PROPERTY_VERSION
constexpr int error_out_of_memory = 4, error_cancelled = 6;

}  // namespace

Embree::Embree(const std::string &path) {
    check_processor();
    try {
        library_.emplace(path);
        functions_ = resolve_functions(*library_);
    } catch (const LibraryError &error) {
        throw EmbreeError(std::string("Embree cannot be loaded: ") + error.what());
    }
    const std::string slots = std::to_string(thread_count(0));
    const std::string joined = "threads=" + slots + ",user_threads=" + slots;
    device_ = functions_.rtcNewDevice(builds_are_joined ? joined.c_str() : nullptr);
    if (!device_) throw EmbreeError("Embree cannot be started on this processor");
    version_ = static_cast<uint32_t>(functions_.rtcGetDeviceProperty(device_, property_version));
    // The ray and hit structures above are those of 4.3 and later; another major version may differ in anything.
    if (version_ < 40300 || version_ >= 50000) {
        functions_.rtcReleaseDevice(device_);
        throw EmbreeError("Embree 4.3 or later of version 4 is needed, but version number " + std::to_string(version_) +
                          " was found");
    }
}

Embree::~Embree() { functions_.rtcReleaseDevice(device_); }

void Embree::commit(std::span<const rtc::Scene> scenes, int threads) const {
    if (builds_are_joined) {
        // Threads leave a scene when it is built, and find all that are.
        const int joining = std::min(threads, thread_count(0));
        parallel_for(joining, static_cast<size_t>(joining), nullptr, [&](size_t) {
            for (const rtc::Scene scene : scenes) functions_.rtcJoinCommitScene(scene);
        });
    }
    // What is built already is left alone; what failed above fails again, where it is seen.
    for (const rtc::Scene scene : scenes) {
        builds_are_joined ? functions_.rtcJoinCommitScene(scene) : functions_.rtcCommitScene(scene);
        check("building the acceleration structure");
    }
}

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
