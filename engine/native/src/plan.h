// SPDX-License-Identifier: GPL-3.0-or-later
// How many photons a pass emits for each map, and how wide the global map's kernels are: by what pilot passes tell of
// noise, blur and cost, so that the picture comes to its error in the least time. A function of scene, camera and
// settings alone: costs are counted in rays, not measured by a clock.
#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include "camera_pass.h"

namespace photon_maps {

/// Photons that a pass emits for each map.
struct PhotonCounts {
    uint64_t global = 0, caustic = 0;
};

/// What one sort of photons does to the pictures of passes that emit `count`.
struct MapNoise {
    double variance = 0;  ///< relative to squared radiance as ErrorEstimate has it
    double blur = 0;      ///< relative square of the error by the kernel's width
    double count = 0;     ///< emitted in a pass
    double cost = 0;      ///< of tracing and storing one of them, in rays

    /// Relative standard deviation of a pass that emits so many, by kernels of the same width.
    double deviation(uint64_t emitted) const {
        return emitted > 0 ? std::sqrt(variance * count / static_cast<double>(emitted)) : 0;
    }
};

/// What pilot passes found.
struct PilotNoise {
    double camera_variance = 0;  ///< of all that photons do not carry
    double direct_variance = 0;  ///< part of it that more light samples take away
    double path_variance = 0;    ///< part of it by diffuse bounces of cameras' paths
    MapNoise global, caustic;
    double lack = 0;         ///< relative square of the light that is missing in all pilot passes
    double pixel_cost = 0;   ///< of the cameras' paths and their estimates of a whole pass, in rays
    double light_cost = 0;   ///< of so many more light samples in a whole pass, in rays
    double gather_cost = 0;  ///< of the photons in the kernels of a whole pass, in rays

    /// The same for passes with so many light samples in the place of one.
    PilotNoise with_light_samples(uint32_t count) const;
};

struct Plan {
    PhotonCounts counts;
    uint32_t light_samples = 1;
    float global_radius = 1;                                ///< over that of the pilot passes
    double passes = 0;                                      ///< until the picture has its error
    double cost = std::numeric_limits<double>::infinity();  ///< in rays, until the picture has its error
};

/// Chooses what comes to an error in the least time. The variance of a map falls with its photons and with the square
/// of the radius, its blur grows with the radius.
/// @param error > 0, relative
/// @param shrinks whether radii shrink from pass to pass (shrunk_radius)
Plan plan_for(const PilotNoise &noise, double error, bool shrinks);

/// Light that photons bring evenly, and paths sometimes by a few samples of many.
enum class RareLight { caustics, indirect };

/// Some pixels of the frame, followed over the pilot passes.
class PilotPixels {
  public:
    static constexpr uint32_t passes = 4;

    /// @param is_nested whether caustics are gathered by nested radii
    PilotPixels(const Camera &camera, bool is_nested);

    /// Renders the pixels in one pass: of `passes` with consecutive indices, so that they stratify each other as those
    /// of a picture do.
    /// @throws Cancelled once `cancel` is set
    void add(const CameraPass &pass, const std::atomic<bool> *cancel);

    /// Rays and estimates of a pixel in a pass, on average, in rays.
    double pixel_cost() const;
    /// Light samples of a pixel in a pass at first diffuse vertices, on average.
    double light_samples() const { return per_pixel(counts_.light_samples); }
    /// Most that the variance of a pass's light of a kind may be without it showing in the pilots, relative to squared
    /// radiance: where few samples bring such light, those that happened to come tell little of the others.
    /// @param photons the same pixels with that light by photons, which tell how much there is to come
    double hidden_variance(RareLight light, const PilotPixels &photons) const;
    /// Sets the variances and the blur that the passes tell, once all are added.
    void find_noise(PilotNoise &noise) const;
    /// Relative square of the light that the pixels lack on average but others have, as far as noise cannot be the
    /// reason: what comes too seldom to be seen in any pilot has no variance that would tell.
    double squared_lack(const PilotPixels &other) const;

  private:
    /// Sum over the passes of a part of a pixel's radiance, of its squares, and of the first half less the second.
    struct Moments {
        Vec3 sum, squares, difference;

        void add(Vec3 value, bool is_of_first_half) {
            sum += value;
            squares += value * value;
            difference += is_of_first_half ? value : -value;
        }
    };
    /// Samples of a kind of light.
    struct Samples {
        double sum = 0, squares = 0;

        void add(double value) {
            sum += value;
            squares += value * value;
        }
        /// By how many samples the light seems to come (Kish 1965).
        double count() const { return squares > 0 ? sum * sum / squares : 0; }
    };
    struct Pixel {
        uint32_t x, y;  ///< in the frame
        Moments camera, direct, global, caustic, global_blur, caustic_blur;
        std::array<Vec3, passes> radiance;
    };

    std::vector<Vec3> means() const;
    double per_pixel(uint64_t count) const {
        return static_cast<double>(count) / static_cast<double>(pixels_.size() * passes);
    }

    std::vector<Pixel> pixels_;
    bool is_nested_;
    uint32_t added_ = 0;
    RayCounts counts_;
    Samples caustics_, indirect_;
};

/// A way to bring the light of diffuse bounces, and what pilot passes tell of it.
struct Pilot {
    Indirect indirect;
    PilotPixels pixels;
    PilotNoise noise;
};

}  // namespace photon_maps
