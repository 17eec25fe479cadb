// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 1 of a render: which photons it traces, and the maps that are made of them.
#include "parallel.h"
#include "render.h"
#include "sequence.h"

namespace photon_maps {

namespace {

constexpr uint32_t photon_stream = 0x70686f74, caustic_stream = 0x63617573;

/// Whether all that scatters or shines is the same to rays of every kind but the camera's. Photons come the way of
/// shadow rays and stay where a diffuse ray would have met their source.
bool is_seen_alike(const Scene &scene, const WorldLight &world) {
    constexpr uint32_t kinds = 1u << PM_RAY_DIFFUSE | 1u << PM_RAY_GLOSSY | 1u << PM_RAY_TRANSMISSION;
    const auto is_same = [&](const Instance &instance) {
        return (instance.visibility & kinds) == 0 || (instance.visibility & kinds) == kinds;
    };
    const auto asks = [&](uint32_t material) { return scene.materials[material].traits.depends_on_ray; };
    return std::ranges::all_of(scene.instances, is_same) && std::ranges::none_of(scene.slot_materials, asks) &&
           !world.depends_on_ray();
}

}  // namespace

bool Render::traces(PhotonPurpose purpose) const {
    const bool wants_photons =
        (settings_.integrator == Integrator::photon_map || is_guided()) && settings_.max_bounces > 0;
    if (!wants_photons || emission_.empty() || scene_.instances.empty() || !receives_) return false;
    if (purpose == PhotonPurpose::caustic)
        return settings_.use_caustics && emission_.has_casters() && indirect_ != Indirect::all_paths;
    return settings_.use_indirect && indirect_ != Indirect::paths && indirect_ != Indirect::all_paths;
}

/// Whether caustics are gathered by nested radii, as far as is known.
bool Render::is_nested() const {
    if (first_radii_ && first_radii_->caustic == 0) return false;
    return settings_.is_nested && settings_.integrator == Integrator::photon_map && traces(PhotonPurpose::caustic);
}

/// Whether photons bring caustics to rough reflections. Their mean direction would tell nothing of a lobe.
bool Render::gathers_rough() const {
    return traces(PhotonPurpose::caustic) && first_radii_->caustic > 0 && !settings_.mean_direction &&
           is_seen_alike(scene_, lights_.world_light());
}

/// Whether photons tell camera paths where to go on diffusely.
bool Render::is_guided() const {
    const bool goes_on = settings_.integrator == Integrator::path_tracing ||
                         (settings_.integrator == Integrator::photon_map && indirect_ != Indirect::photons);
    return settings_.use_photon_guiding && goes_on;
}

bool Render::marks_shadows() const {
    return settings_.use_shadow_photons && settings_.integrator == Integrator::photon_map;
}

PhotonTracing Render::tracing(PhotonPurpose purpose, uint32_t index) const {
    const uint32_t stream = purpose == PhotonPurpose::caustic ? caustic_stream : photon_stream;
    const bool is_global = purpose == PhotonPurpose::global;
    const uint64_t count = is_global ? counts_.global : counts_.caustic;
    return {purpose,
            count * index,
            count,
            settings_.max_bounces,
            hash(settings_.seed, stream),
            settings_.threads,
            settings_.keep_photons || (is_global && indirect_ == Indirect::gather),
            is_global && marks_shadows()};
}

PhotonMap Render::map_of(std::vector<Photon> photons) const {
    return PhotonMap(std::move(photons), settings_.threads, &cancel_);
}

/// What a pass traces, for the maps that there are.
std::vector<PhotonTracing> Render::tracings(uint32_t index) const {
    std::vector<PhotonTracing> wanted;
    if (first_radii_->indirect > 0) {
        wanted.push_back(tracing(PhotonPurpose::global, index));
        if (indirect_ == Indirect::gather) --wanted.back().max_bounces;  // the gathering ray is a bounce more
    }
    if (first_radii_->caustic > 0) wanted.push_back(tracing(PhotonPurpose::caustic, index));
    return wanted;
}

TracedPhotons Render::trace(uint32_t index) {
    TracedPhotons photons;
    for (const PhotonTracing &wanted : tracings(index)) {
        TracedPhotons traced = trace_photons(scene_, emission_, wanted, &cancel_);
        if (wanted.purpose == PhotonPurpose::global) {
            photons = std::move(traced);
            continue;
        }
        photons.photons[PM_PHOTONS_CAUSTIC] = std::move(traced.photons[PM_PHOTONS_CAUSTIC]);
        photons.rays += traced.rays;
        photons.caustic_rays = traced.rays;
    }
    return photons;
}

/// Builds what pass 2 asks of the photons, whose lists end here unless they are kept.
Maps Render::build_maps(TracedPhotons &photons, const Radii &radii, bool keeps_lists) const {
    Maps maps;
    if (is_guided() && radii.indirect > 0) maps.importance = importance_of(photons);
    if (marks_shadows() && radii.indirect > 0) maps.shadow_photons.emplace(photons.shadow_photons, radii.indirect / 2);
    const size_t beside = (maps.importance ? maps.importance->memory_bytes() : 0) +
                          (maps.shadow_photons ? maps.shadow_photons->memory_bytes() : 0) +
                          photons.shadow_photons.size() * sizeof(ShadowPhoton);
    photons.shadow_photons = {};
    const auto count_memory = [&](size_t listed) {
        maps.memory_bytes = std::max(maps.memory_bytes, beside + listed * sizeof(Photon) + maps.global.memory_bytes() +
                                                            maps.caustic.memory_bytes());
    };
    count_memory(photons.size());
    const auto take = [&](pm_photon_kind kind) {
        return keeps_lists ? photons[kind] : std::exchange(photons.photons[kind], {});
    };
    const auto build = [&](PhotonMap &map, std::vector<Photon> list) {
        map = map_of(std::move(list));
        count_memory(photons.size());
    };
    if (settings_.integrator != Integrator::photon_map) return maps;
    if (radii.indirect > 0 && indirect_ == Indirect::gather) {
        // Where the rays of a final gather end, photons bring the lights' own light too.
        std::vector<Photon> all = take(PM_PHOTONS_DIRECT);
        {
            const std::vector<Photon> indirect = take(PM_PHOTONS_INDIRECT);
            count_memory(photons.size() + 2 * (all.size() + indirect.size()));
            all.insert(all.end(), indirect.begin(), indirect.end());
        }
        build(maps.global, std::move(all));
    } else if (radii.indirect > 0) {
        build(maps.global, take(PM_PHOTONS_INDIRECT));
    }
    if (radii.caustic > 0) build(maps.caustic, take(PM_PHOTONS_CAUSTIC));
    return maps;
}

/// What paths do not find by light sampling nor in a map: in path tracing caustics too.
PhotonImportance Render::importance_of(const TracedPhotons &photons) const {
    // Photons that only tell where to go are not summed: their cubes need not shrink.
    PhotonImportance importance(2 * first_radii_->indirect);
    importance.add(photons[PM_PHOTONS_INDIRECT]);
    if (settings_.integrator == Integrator::path_tracing) importance.add(photons[PM_PHOTONS_CAUSTIC]);
    return importance;
}

PhotonMaps Render::gathers_of(const Maps &maps, const Radii &radii) const {
    const auto gather = [&](const PhotonMap &map, float radius) -> PhotonGather {
        Kernel kernel = settings_.kernel;
        kernel.radius = radius;
        return {&map, edges_.get(), coverage_.get(), kernel, settings_.nearest_count, settings_.mean_direction};
    };
    return {gather(maps.global, radii.indirect), gather(maps.caustic, radii.caustic)};
}

}  // namespace photon_maps
