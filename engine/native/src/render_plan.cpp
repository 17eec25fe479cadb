// SPDX-License-Identifier: GPL-3.0-or-later
// What a render decides before its first pass: the radii, and the photons of a pass.
#include "parallel.h"
#include "radius.h"
#include "render.h"

namespace photon_maps {

namespace {

/// The largest of the nested radii over one that must serve all pixels: too large for many does no harm.
constexpr float largest_nested = 1.4f;
/// The global map's kernel in pilot passes over the one that serves without a plan: blur shows better in a large one,
/// and where there is none the large one has less noise.
constexpr float pilot_radius = 1.41f;

}  // namespace

/// Whether photons, radius and more follow from pilot passes.
bool Render::is_planned() const {
    return settings_.use_auto && settings_.photon_count == 0 && !(settings_.kernel.radius > 0) &&
           settings_.integrator == Integrator::photon_map;
}

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
    if (is_planned()) radii.indirect *= pilot_radius;

    // A radius of the engine's own choice is no larger than lets a kernel meet a bearable number of edges.
    Kernel largest = settings_.kernel;
    largest.radius = std::max(radii.indirect, radii.caustic);
    if (largest.radius > 0) {
        const std::span<const FeatureEdge> edges = scene_.feature_edges();
        auto index = std::make_shared<EdgeIndex>(std::vector<FeatureEdge>(edges.begin(), edges.end()), largest.radius);
        constexpr double bearable_crowding = 1024;
        constexpr int most_halvings = 12;
        for (int halving = 0; is_chosen && index->crowding() > bearable_crowding && halving < most_halvings;
             ++halving) {
            throw_if_cancelled(&cancel_);
            largest.radius /= 2;
            *index = EdgeIndex({edges.begin(), edges.end()}, largest.radius);
        }
        edges_ = std::move(index);
        coverage_ = std::make_shared<Coverage>(scene_, *edges_, largest);
    }
    first_radii_ = {std::min(radii.indirect, largest.radius), std::min(radii.caustic, largest.radius)};
}

/// The ways to bring the light of diffuse bounces that are open to the plan, the usual one first.
std::vector<Indirect> Render::ways() const {
    const bool may_go_by_paths = first_radii_->indirect > 0 && indirect_ == Indirect::photons && !marks_shadows() &&
                                 !settings_.use_photon_guiding;
    if (!may_go_by_paths) return {indirect_};
    // Without a caustic map paths leave nothing to photons.
    if (first_radii_->caustic == 0) return {indirect_, Indirect::paths};
    return {indirect_, Indirect::paths, Indirect::all_paths};
}

/// Pilot passes are the last that a picture could have, with fewer photons; no picture sums them, for a plan from what
/// is summed would not be blind to it.
std::vector<Pilot> Render::run_pilot_passes() {
    std::vector<Pilot> pilots;
    for (const Indirect way : ways()) pilots.emplace_back(way, PilotPixels(camera_, is_nested()));
    uint64_t rays = 0, stored = 0, caustic_rays = 0, caustic_stored = 0;
    for (uint32_t i = 0; i < PilotPixels::passes; ++i) {
        const uint32_t index = std::numeric_limits<uint32_t>::max() - i;
        TracedPhotons photons = trace(index);
        rays += photons.rays - photons.caustic_rays;
        caustic_rays += photons.caustic_rays;
        caustic_stored += photons[PM_PHOTONS_CAUSTIC].size();
        stored += photons.size() - photons[PM_PHOTONS_CAUSTIC].size();
        const Maps maps = build_maps(photons, *first_radii_, false);
        const PhotonMaps gathers = gathers_of(maps, *first_radii_);
        for (Pilot &pilot : pilots)
            pilot.pixels.add(camera_pass(camera_, maps, gathers, pilot.indirect, index), &cancel_);
    }

    // Costs are counted in rays: what else there is to do takes about so many times as long as a ray.
    constexpr double storing_cost = 0.1, light_sample_cost = 2;
    const auto cost = [](uint64_t traced, uint64_t kept, uint64_t count) {
        const auto emitted = static_cast<double>(count * PilotPixels::passes);
        return (static_cast<double>(traced) + storing_cost * static_cast<double>(kept)) / emitted;
    };
    const double frame = static_cast<double>(camera_.frame_width) * camera_.frame_height;
    for (Pilot &pilot : pilots) {
        PilotNoise &noise = pilot.noise;
        pilot.pixels.find_noise(noise);
        for (const Pilot &other : pilots) noise.lack = std::max(noise.lack, pilot.pixels.squared_lack(other.pixels));
        noise.pixel_cost = frame * pilot.pixels.pixel_cost();
        noise.light_cost = frame * light_sample_cost * pilot.pixels.light_samples();
        if (settings_.light_samples > 0) noise.direct_variance = 0;  // they are not for the plan to choose
        if (pilot.indirect == Indirect::all_paths) {
            noise.camera_variance += pilot.pixels.hidden_caustic_variance(pilots.front().pixels);
        } else if (first_radii_->caustic > 0) {
            noise.caustic.count = static_cast<double>(counts_.caustic);
            noise.caustic.cost = cost(caustic_rays, caustic_stored, counts_.caustic);
        }
        if (first_radii_->indirect > 0 && pilot.indirect <= Indirect::gather) {
            noise.global.count = static_cast<double>(counts_.global);
            noise.global.cost = cost(rays, stored, counts_.global);
        }
    }
    return pilots;
}

void Render::make_plan() {
    constexpr uint64_t most_pilot_photons = 1 << 13;
    if (!is_planned() || (first_radii_->indirect == 0 && first_radii_->caustic == 0)) return;

    // See what a few passes bring to some pixels.
    const PhotonCounts usual = counts_;
    counts_ = {std::min(usual.global, most_pilot_photons), std::min(usual.caustic, most_pilot_photons)};
    std::vector<Pilot> pilots = run_pilot_passes();

    // The kernels were chosen to hold so many of the usual number of photons, which in the end take time too.
    constexpr double photon_cost = 0.005;
    const double photons_in_kernel = double{usual_photons_in_kernel} * pilot_radius * pilot_radius *
                                     static_cast<double>(counts_.global) / static_cast<double>(usual.global);
    pilots.front().noise.gather_cost =
        static_cast<double>(camera_.frame_width) * camera_.frame_height * photon_cost * photons_in_kernel;

    // What comes to the error in the least time; without one to stop at, to that which most pictures are made for.
    constexpr double usual_error = 0.02;
    const double error = settings_.stop_error > 0 ? double{settings_.stop_error} : usual_error;
    const Pilot *best = nullptr;
    Plan plan;
    for (const Pilot &pilot : pilots) {
        const Plan found = plan_for(pilot.noise, error, settings_.use_progressive);
        if (!(found.cost < plan.cost)) continue;
        best = &pilot;
        plan = found;
    }
    if (!best) {  // noise beyond all numbers tells nothing
        counts_ = usual;
        return;
    }
    pilot_noise_ = best->noise.with_light_samples(plan.light_samples);
    light_samples_ *= plan.light_samples;
    indirect_ = best->indirect;
    counts_ = plan.counts;
    first_radii_->indirect *= plan.global_radius;
    // Maps that are not built have no radius; their count is what they would have.
    if (!traces(PhotonPurpose::global)) first_radii_->indirect = 0;
    if (!traces(PhotonPurpose::caustic)) first_radii_->caustic = 0;
    if (first_radii_->indirect == 0) counts_.global = usual.global;
    if (first_radii_->caustic == 0) counts_.caustic = usual.caustic;
}

}  // namespace photon_maps
