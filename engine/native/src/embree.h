// SPDX-License-Identifier: GPL-3.0-or-later
// The Embree 4 that `embreex` brings: loaded by full path, never by whichever rtc* symbol the process offers.
// This file alone knows Embree's binary interface (embree4/rtcore_*.h of version 4.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "dynamic_library.h"

namespace photon_maps {

/// Embree is missing, of another version, or failed.
struct EmbreeError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace rtc {

constexpr uint32_t invalid_id = 0xffffffffu;

struct alignas(16) Ray {
    float org_x, org_y, org_z, tnear;
    float dir_x, dir_y, dir_z, time;
    float tfar;
    uint32_t mask, id, flags;
};

struct alignas(16) Hit {
    float ng_x, ng_y, ng_z, u, v;
    uint32_t primitive, geometry;
    uint32_t instance, instance_primitive;  // the second since Embree 4.3
};

struct RayHit {
    Ray ray;
    Hit hit;
};
static_assert(sizeof(RayHit) == 96);

enum class GeometryType : int { triangle = 0, instance = 121 };
enum class BufferType : int { index = 0, vertex = 1 };
enum class Format : int { uint3 = 0x5003, float3 = 0x9003, float3x4_row_major = 0x9134 };
enum class SceneFlags : int { robust = 4 };
enum class BuildQuality : int { medium = 1 };

using Device = struct DeviceHandle *;
using Scene = struct SceneHandle *;
using Geometry = struct GeometryHandle *;

/// The functions in use, under Embree's own names.
struct Functions {
    Device (*rtcNewDevice)(const char *);
    void (*rtcReleaseDevice)(Device);
    ptrdiff_t (*rtcGetDeviceProperty)(Device, int);
    int (*rtcGetDeviceError)(Device);
    Scene (*rtcNewScene)(Device);
    void (*rtcReleaseScene)(Scene);
    void (*rtcSetSceneFlags)(Scene, SceneFlags);
    void (*rtcSetSceneBuildQuality)(Scene, BuildQuality);
    void (*rtcSetSceneProgressMonitorFunction)(Scene, bool (*monitor)(void *, double), void *);
    void (*rtcCommitScene)(Scene);
    void (*rtcJoinCommitScene)(Scene);
    Geometry (*rtcNewGeometry)(Device, GeometryType);
    void (*rtcReleaseGeometry)(Geometry);
    void (*rtcCommitGeometry)(Geometry);
    void (*rtcAttachGeometryByID)(Scene, Geometry, uint32_t);
    void (*rtcSetSharedGeometryBuffer)(Geometry, BufferType, uint32_t slot, Format, const void *, size_t offset,
                                       size_t stride, size_t count);
    void (*rtcSetGeometryInstancedScene)(Geometry, Scene);
    void (*rtcSetGeometryMask)(Geometry, uint32_t mask);
    void (*rtcSetGeometryTransform)(Geometry, uint32_t step, Format, const void *);
    void (*rtcIntersect1)(Scene, RayHit *, void *arguments);
    void (*rtcOccluded1)(Scene, Ray *, void *arguments);
};

}  // namespace rtc

/// Whether Embree builds by threads that join it, in place of its own, which would sleep in its code for good: so that
/// Windows can free the library and replace its file. A build by such threads cannot be cancelled, for each of them
/// would have to bear the same exception (oneTBB's task_group::wait()).
#if defined(_WIN32)
constexpr bool builds_are_joined = true;
#else
constexpr bool builds_are_joined = false;
#endif

/// A loaded Embree with one device; shared by the scenes made on it.
class Embree {
  public:
    /// Loads the library at `path` and creates a device.
    /// @throws EmbreeError if the file cannot be loaded, lacks a function, or is not Embree 4.3 or later.
    explicit Embree(const std::string &path);
    Embree(const Embree &) = delete;
    Embree &operator=(const Embree &) = delete;
    ~Embree();

    const rtc::Functions &functions() const { return functions_; }
    rtc::Device device() const { return device_; }
    /// major * 10000 + minor * 100 + patch
    uint32_t version() const { return version_; }
    /// Builds scenes, the instanced before those that hold them, with up to so many threads of the caller's where
    /// builds are joined.
    /// @throws as check()
    void commit(std::span<const rtc::Scene> scenes, int threads) const;
    /// @throws EmbreeError if a call failed since the last check; Cancelled or std::bad_alloc if that was why.
    void check(const char *what) const;

  private:
    std::optional<DynamicLibrary> library_;
    rtc::Functions functions_{};
    rtc::Device device_ = nullptr;
    uint32_t version_ = 0;
};

}  // namespace photon_maps
