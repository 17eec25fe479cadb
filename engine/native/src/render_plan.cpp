// SPDX-License-Identifier: GPL-3.0-or-later
// What a render decides before its first pass: the radii, and the photons of a pass.
#include "parallel.h"
#include "radius.h"
#include "render.h"

namespace photon_maps {

namespace {

/// The largest of the nested radii over one that must serve all pixels: too large for many does no harm.
constexpr float largest_nested = 1.4f;

}  // namespace

void Render::choose_radii() {
    // A radius by hand holds for both maps.
    Radii radii{settings_.kernel.radius, settings_.kernel.radius};
    const bool is_chosen = !(settings_.kernel.radius > 0);
    if (!traces(PhotonPurpose::global))
        radii.indirect = 0;
    else if (is_chosen)
        radii.indirect =
            choose_indirect_radius(scene_, emission_, camera_, tracing(PhotonPurpose::global, 0), &cancel_);
    if (!traces(PhotonPurpose::caustic))
        radii.caustic = 0;
    else if (is_chosen)
        radii.caustic = choose_caustic_radius(scene_, emission_, camera_, tracing(PhotonPurpose::caustic, 0), &cancel_);
    if (is_chosen && is_nested()) radii.caustic *= largest_nested;

    // A radius of the engine's own choice is no larger than lets a kernel meet a bearable number of edges.
    Kernel largest = settings_.kernel;
    largest.radius = std::max(radii.indirect, radii.caustic);
    if (largest.radius > 0) {
        const std::span<const FeatureEdge> edges = scene_.feature_edges();
        edges_ = EdgeIndex({edges.begin(), edges.end()}, largest.radius);
        constexpr double bearable_crowding = 1024;
        constexpr int most_halvings = 12;
        for (int halving = 0; is_chosen && edges_.crowding() > bearable_crowding && halving < most_halvings;
             ++halving) {
            throw_if_cancelled(&cancel_);
            largest.radius /= 2;
            edges_ = EdgeIndex({edges.begin(), edges.end()}, largest.radius);
        }
        coverage_.emplace(scene_, edges_, largest);
    }
    first_radii_ = {std::min(radii.indirect, largest.radius), std::min(radii.caustic, largest.radius)};
}

/// Pilot passes are the last that a picture could have, with fewer photons; no picture sums them, for a plan from what
/// is summed would not be blind to it.
PilotNoises Render::run_pilot_passes() {
    PilotPixels by_photons(camera_, is_nested()), by_paths(camera_, is_nested());
    uint64_t rays = 0, stored = 0, caustic_rays = 0, caustic_stored = 0;
    for (uint32_t pilot = 0; pilot < PilotPixels::passes; ++pilot) {
        const uint32_t index = std::numeric_limits<uint32_t>::max() - pilot;
        TracedPhotons photons = trace(index);
        rays += photons.rays - photons.caustic_rays;
        caustic_rays += photons.caustic_rays;
        caustic_stored += photons[PM_PHOTONS_CAUSTIC].size();
        stored += photons.size() - photons[PM_PHOTONS_CAUSTIC].size();
        const Maps maps = build_maps(photons, *first_radii_);
        const PhotonMaps gathers = gathers_of(maps, *first_radii_);
        by_photons.add(camera_pass(camera_, maps, gathers, index), &cancel_);
        CameraPass paths = camera_pass(camera_, maps, gathers, index);
        paths.indirect = Indirect::paths;
        by_paths.add(paths, &cancel_);
    }

    // Costs are counted in rays: what else there is to do takes about so many times as long as a ray.
    constexpr double query_cost = 2.5, storing_cost = 0.1;
    const auto cost = [](uint64_t traced, uint64_t kept, uint64_t count) {
        const auto emitted = static_cast<double>(count * PilotPixels::passes);
        return (static_cast<double>(traced) + storing_cost * static_cast<double>(kept)) / emitted;
    };
    PilotNoises noises;
    by_photons.find_noise(noises.photons);
    by_paths.find_noise(noises.paths);
    noises.photons.lack = by_photons.squared_lack(by_paths);
    noises.paths.lack = by_paths.squared_lack(by_photons);
    const double frame = static_cast<double>(camera_.frame_width) * camera_.frame_height;
    const bool has_caustics = first_radii_->caustic > 0, has_global = first_radii_->indirect > 0;
    for (PilotNoise *noise : {&noises.photons, &noises.paths}) {
        if (!has_caustics) continue;
        noise->caustic.count = static_cast<double>(counts_.caustic);
        noise->caustic.cost = cost(caustic_rays, caustic_stored, counts_.caustic);
    }
    if (has_global) {
        noises.photons.global.count = static_cast<double>(counts_.global);
        noises.photons.global.cost = cost(rays, stored, counts_.global);
    }
    noises.photons.pixel_cost = frame * (by_photons.rays_per_pixel() + query_cost * (has_caustics + has_global));
    noises.paths.pixel_cost = frame * (by_paths.rays_per_pixel() + query_cost * has_caustics);
    return noises;
}

void Render::make_plan() {
    constexpr uint64_t most_pilot_photons = 1 << 13;
    const bool is_planned = settings_.use_auto && settings_.photon_count == 0 && !(settings_.kernel.radius > 0) &&
                            settings_.integrator == Integrator::photon_map;
    if (!is_planned || (first_radii_->indirect == 0 && first_radii_->caustic == 0)) return;

    // See what a few passes bring to some pixels.
    const PhotonCounts usual = counts_;
    counts_ = {std::min(usual.global, most_pilot_photons), std::min(usual.caustic, most_pilot_photons)};
    PilotNoises noises = run_pilot_passes();

    // The kernels were chosen to hold so many of the usual number of photons, which in the end take time too.
    constexpr double photon_cost = 0.005;
    const double photons_in_kernel =
        usual_photons_in_kernel * static_cast<double>(counts_.global) / static_cast<double>(usual.global);
    noises.photons.gather_cost =
        static_cast<double>(camera_.frame_width) * camera_.frame_height * photon_cost * photons_in_kernel;

    // Without an error to stop at, the one that most pictures are made for.
    constexpr double usual_error = 0.02;
    const double error = settings_.stop_error > 0 ? double{settings_.stop_error} : usual_error;
    const Plan by_photons = plan_for(noises.photons, error, settings_.use_progressive);
    const Plan by_paths = plan_for(noises.paths, error, settings_.use_progressive);
    const bool takes_paths = may_go_by_paths() && by_paths.cost < by_photons.cost;
    const Plan &plan = takes_paths ? by_paths : by_photons;
    pilot_noise_ = takes_paths ? noises.paths : noises.photons;
    counts_ = plan.counts;
    first_radii_->indirect *= plan.global_radius;
    if (!takes_paths) return;
    counts_.global = usual.global;  // what a global map would have
    first_radii_->indirect = 0;
    indirect_ = Indirect::paths;
}

/// Whether nothing but the light of diffuse bounces is asked of the global map's photons.
bool Render::may_go_by_paths() const {
    return first_radii_->indirect > 0 && indirect_ == Indirect::photons && !marks_shadows() &&
           !settings_.use_photon_guiding;
}

}  // namespace photon_maps
