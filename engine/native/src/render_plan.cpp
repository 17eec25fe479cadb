// SPDX-License-Identifier: GPL-3.0-or-later
// What a render decides before its first pass: the radii, and the photons of a pass.
#include <algorithm>
#include <cmath>

#include "crossing_edges.h"
#include "memory_limit.h"
#include "parallel.h"
#include "radius.h"
#include "render.h"
#include "sequence.h"

namespace photon_maps {

namespace {

/// The largest of the nested radii over one that must serve all pixels: too large for many does no harm.
constexpr float largest_nested = 1.4f;
/// The global map's kernel in pilot passes over the one that serves without a plan: blur shows better in a large one,
/// where there is less noise.
constexpr float pilot_radius = 2;

}  // namespace

/// Whether photons, radius and more follow from pilot passes.
bool Render::is_planned() const {
    return settings_.use_auto && settings_.photon_count == 0 && !(settings_.kernel.radius > 0) &&
           settings_.integrator == Integrator::photon_map;
}

/// Lets a pass emit no more photons than what it stores has room for in memory.
void Render::limit_counts() {
    const size_t taken =
        scene_.memory_bytes() + picture_bytes(camera_.width, camera_.height, settings_.buffers) + map_cache_.limit();
    const bool has_copies = settings_.keep_photons || indirect_ == Indirect::gather;
    const double room = photons_with_room(settings_.memory_limit, taken, has_copies);
    // Seldom is a photon stored so many times; where even then there is room, nothing more needs to be known.
    constexpr double often_stored = 256;
    if (often_stored * (static_cast<double>(counts_.global) + static_cast<double>(counts_.caustic)) <= room) return;

    // Pilot photons tell how many are stored for each that both maps emit.
    constexpr uint64_t most_pilot_photons = 1 << 14;
    constexpr uint32_t room_stream = 0x726f6f6d;
    double stored = 0;
    for (const PhotonPurpose purpose : {PhotonPurpose::global, PhotonPurpose::caustic}) {
        if (!traces(purpose)) continue;
        PhotonTracing pilot = tracing(purpose, 0);
        pilot.count = std::min(pilot.count, most_pilot_photons);
        pilot.seed = hash(pilot.seed, room_stream);
        stored += static_cast<double>(trace_photons(scene_, emission_, pilot, &cancel_).size()) /
                  static_cast<double>(pilot.count);
    }
    const auto most = static_cast<uint64_t>(stored > 0 ? std::clamp(room / stored, 1.0, 0x1p62) : 0x1p62);
    is_limited_ = is_limited_ || std::max(counts_.global, counts_.caustic) > most;
    counts_ = {std::min(counts_.global, most), std::min(counts_.caustic, most)};
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

    // What bounds kernels. Of crossings in finer meshes there would be more than a kernel can bear, and more rays to
    // find them than they are worth.
    constexpr float shortest_crossing = 0.25f;
    const float largest = std::max(radii.indirect, radii.caustic);
    if (largest > 0) {
        kernel_bounds_ = find_crossing_edges(scene_, shortest_crossing * largest, settings_.threads, &cancel_);
        kernel_bounds_.insert(kernel_bounds_.end(), scene_.feature_edges().begin(), scene_.feature_edges().end());
    }
    if (is_planned()) radii.indirect *= pilot_radius;
    set_radii(radii);
}

/// Takes kernels for the first pass, and finds the edges and the bends that they meet.
void Render::set_radii(Radii radii) {
    if (first_radii_ == radii) return;
    // A radius of the engine's own choice is no larger than lets a kernel meet a bearable number of edges.
    const bool is_chosen = !(settings_.kernel.radius > 0);
    Kernel largest = settings_.kernel;
    largest.radius = std::max(radii.indirect, radii.caustic);
    if (largest.radius > 0) {
        auto index = std::make_shared<EdgeIndex>(kernel_bounds_, largest.radius);
        constexpr double bearable_crowding = 1024;
        constexpr int most_halvings = 12;
        for (int halving = 0; is_chosen && index->crowding() > bearable_crowding && halving < most_halvings;
             ++halving) {
            throw_if_cancelled(&cancel_);
            largest.radius /= 2;
            *index = EdgeIndex(kernel_bounds_, largest.radius);
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
/// @param first number of passes that other pilots had
std::vector<Pilot> Render::run_pilot_passes(uint32_t first, std::span<const Indirect> ways) {
    std::vector<Pilot> pilots;
    for (const Indirect way : ways) pilots.emplace_back(way, PilotPixels(camera_, is_nested()));
    uint64_t rays = 0, stored = 0, caustic_rays = 0, caustic_stored = 0;
    for (uint32_t i = 0; i < PilotPixels::passes; ++i) {
        const uint32_t index = std::numeric_limits<uint32_t>::max() - first - i;
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
    const double stratification = pilots.front().pixels.stratification();  // of what the eye sees alike by all ways
    for (Pilot &pilot : pilots) {
        PilotNoise &noise = pilot.noise;
        pilot.pixels.find_noise(noise);
        noise.stratification = stratification;
        for (const Pilot &other : pilots) noise.lack = std::max(noise.lack, pilot.pixels.squared_lack(other.pixels));
        noise.pixel_cost = frame * pilot.pixels.pixel_cost();
        noise.light_cost = frame * light_sample_cost * pilot.pixels.light_samples();
        if (pilot.indirect >= Indirect::paths)
            noise.camera_variance = std::max(noise.camera_variance,
                                             pilot.pixels.hidden_variance(RareLight::indirect, pilots.front().pixels));
        if (pilot.indirect == Indirect::all_paths) {
            noise.camera_variance += pilot.pixels.hidden_variance(RareLight::caustics, pilots.front().pixels);
        } else if (first_radii_->caustic > 0) {
            noise.caustic.count = static_cast<double>(counts_.caustic);
            noise.caustic.cost = cost(caustic_rays, caustic_stored, counts_.caustic);
        }
        if (pilot.indirect != Indirect::photons) noise.path_variance = noise.camera_variance - noise.direct_variance;
        if (settings_.light_samples > 0) noise.direct_variance = 0;  // they are not for the plan to choose
        if (first_radii_->indirect > 0 && pilot.indirect <= Indirect::gather) {
            noise.global.count = static_cast<double>(counts_.global);
            noise.global.cost = cost(rays, stored, counts_.global);
        }
        // What a final gather's own rays bring to noise falls with no radius either, but nor does it with photons.
        if (pilot.indirect == Indirect::gather) noise.global.flux_variance = 0;
    }
    return pilots;
}

void Render::make_plan() {
    constexpr uint64_t few_pilot_photons = 1 << 13;
    constexpr double share_of_pilots = 0.04, worthwhile = 2, most = 16;
    if (!is_planned() || (first_radii_->indirect == 0 && first_radii_->caustic == 0)) return;

    // See what a few passes of few photons bring to some pixels.
    const PhotonCounts usual = counts_;
    counts_ = {std::min(usual.global, few_pilot_photons), std::min(usual.caustic, few_pilot_photons)};
    std::optional<Choice> choice = choose_by_pilots(0, ways(), usual);
    if (!choice) {  // noise beyond all numbers tells nothing
        counts_ = usual;
        return;
    }

    // Where there will be much to do, look again with more photons: noise hides how kernels blur. Where paths seem
    // better, only if that is next to nothing beside what they have to do.
    const double times = choice->pilot_cost > 0 ? share_of_pilots * choice->plan.cost / choice->pilot_cost : 0;
    if (times >= (choice->pilot.indirect < Indirect::paths ? worthwhile : most)) {
        // By powers of sqrt 2, so that rounding errors, as of another unit of length, do not bring other photons.
        const double step = std::exp2(std::round(2 * std::log2(std::min(times, most))) / 2);
        const auto more = [&](uint64_t count, uint64_t with_room) {
            const auto wanted = static_cast<uint64_t>(step * static_cast<double>(count));
            return is_limited_ ? std::min(wanted, with_room) : wanted;
        };
        counts_ = {more(counts_.global, usual.global), more(counts_.caustic, usual.caustic)};
        if (auto second = choose_by_pilots(PilotPixels::passes, choice->rivals, usual)) choice = std::move(second);
    }

    const Plan &plan = choice->plan;
    pilot_noise_ = choice->pilot.noise.with_light_samples(plan.light_samples);
    light_samples_ *= plan.light_samples;
    indirect_ = choice->pilot.indirect;
    counts_ = plan.counts;
    // Maps that are not built have no radius; their count is what they would have.
    set_radii({traces(PhotonPurpose::global) ? first_radii_->indirect * plan.global_radius : 0,
               traces(PhotonPurpose::caustic) ? first_radii_->caustic : 0});
    if (first_radii_->indirect == 0) counts_.global = usual.global;
    if (first_radii_->caustic == 0) counts_.caustic = usual.caustic;
}

/// Runs pilot passes, and chooses what comes to the error in the least time; without one to stop at, to that which most
/// pictures are made for.
/// @param first, ways as of run_pilot_passes()
/// @param usual photons without a plan
/// @return nothing if no way has a cost
std::optional<Render::Choice> Render::choose_by_pilots(uint32_t first, std::span<const Indirect> ways,
                                                       const PhotonCounts &usual) {
    std::vector<Pilot> pilots = run_pilot_passes(first, ways);

    // The kernels were chosen to hold so many of the usual number of photons, which in the end take time too.
    constexpr double photon_cost = 0.005;
    const double photons_in_kernel = double{usual_photons_in_kernel} * pilot_radius * pilot_radius *
                                     static_cast<double>(counts_.global) / static_cast<double>(usual.global);
    pilots.front().noise.gather_cost =
        static_cast<double>(camera_.frame_width) * camera_.frame_height * photon_cost * photons_in_kernel;

    constexpr double usual_error = 0.02;
    const double error = settings_.stop_error > 0 ? double{settings_.stop_error} : usual_error;
    const PilotNoise &first_way = pilots.front().noise;
    const double pilot_cost = PilotPixels::passes * (first_way.global.cost * first_way.global.count +
                                                     first_way.caustic.cost * first_way.caustic.count);
    std::vector<Plan> plans;
    for (const Pilot &pilot : pilots) plans.push_back(plan_for(pilot.noise, error, settings_.use_progressive));
    const auto best = std::ranges::min_element(plans, {}, &Plan::cost);
    if (!std::isfinite(best->cost)) return {};
    Choice choice{pilots[static_cast<size_t>(best - plans.begin())], *best, pilot_cost, {pilots.front().indirect}};
    // Far off, pilots err by less than this. Of what one way lacks none but the others can tell.
    constexpr double hopeless = 8;
    const bool lacks = std::ranges::any_of(pilots, [](const Pilot &pilot) { return pilot.noise.lack > 0; });
    for (size_t way = 1; way < plans.size(); ++way)
        if (lacks || plans[way].cost < hopeless * best->cost) choice.rivals.push_back(pilots[way].indirect);
    return choice;
}

}  // namespace photon_maps
