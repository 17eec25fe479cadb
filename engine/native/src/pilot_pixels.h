// SPDX-License-Identifier: GPL-3.0-or-later
// What a few passes show of a picture's noise, of how kernels blur it, and of what it costs: seen in some of its
// pixels.
#pragma once

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "camera_pass.h"
#include "plan.h"

namespace photon_maps {

/// For each two passes the mean over pixels of the product of what they differ by; only those of different passes
/// count.
using PassProducts = std::array<std::array<double, PilotNoise::passes>, PilotNoise::passes>;

/// Returns the expected square of what passes have in common, of which not even the order is known before. Noise of
/// different passes is independent, so the product of two tells what they share; how much the products differ tells how
/// far their mean is to be trusted.
double expected_square(const PassProducts &products);

/// Light that photons bring evenly, and paths sometimes by a few samples of many.
enum class RareLight { caustics, indirect };

/// Some pixels of the frame, followed over the pilot passes.
class PilotPixels {
  public:
    static constexpr uint32_t passes = PilotNoise::passes;

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
    /// Power by which the variance of the mean of n passes falls with n, of all that photons do not carry: at least 1,
    /// as of independent passes, and at most PilotNoise::most_stratified.
    double stratification() const;
    /// Sets the variances and the blur that the passes tell, once all are added.
    void find_noise(PilotNoise &noise) const;
    /// Relative square of the light that the pixels lack on average but others have, as far as noise cannot be the
    /// reason: what comes too seldom to be seen in any pilot has no variance that would tell.
    double squared_lack(const PilotPixels &other) const;

  private:
    /// Sum over the passes of a part of a pixel's radiance, and of the first half less the second.
    struct Moments {
        Vec3 sum, difference;

        void add(Vec3 value, bool is_of_first_half) {
            sum += value;
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
    using Passes = std::array<Vec3, passes>;
    struct Pixel {
        uint32_t x, y;  ///< in the frame
        Moments camera, direct, global, caustic;
        Moments narrow;  ///< global by kernels of a quarter of the area
        Passes radiance, camera_light, global_blur, caustic_blur;
    };

    std::vector<Vec3> means() const;
    double squared_blur(Passes Pixel::*part, std::span<const Vec3> means, float floor) const;
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
