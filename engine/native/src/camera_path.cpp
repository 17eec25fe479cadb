// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_path.h"

#include "path_steps.h"

namespace photon_maps {

namespace {

/// A path whose throughput times this is below 1 plays Russian roulette: glossy reflections on plastics bring little,
/// and cost as much as all the rest of their pixel.
constexpr float roulette_scale = 8;

/// Scatterings after which a path goes on by one of reflection and refraction instead of both. What is reflected in
/// water or glass is a small share of the light, but often a lamp: left to chance it was most of the noise of what the
/// eye sees there.
constexpr uint32_t whole_scatterings = 3;

/// The same photons gathered within half the radius.
PhotonGather halved(PhotonGather gather) {
    gather.kernel.radius /= 2;
    if (gather.nearest_count > 0) gather.nearest_count = std::max(1u, gather.nearest_count / 4);
    return gather;
}

}  // namespace

bool CameraPath::step() {
    // What the ray meets: lamps on the way, a surface or the world.
    SurfacePoint hit;
    ++counts_.rays;
    const bool met = pass_.scene.intersect(ray_, hit);
    add_lamps(met ? &hit : nullptr);
    if (!met) {
        add_world();
        return false;
    }
    const float unit = length(ray_.direction);
    state_.length += (hit.distance - ray_.near) * unit;  // Cycles counts from the clip plane on
    state_.footprint = pass_.camera.footprint(state_.length);
    const Shading shading = shade(pass_.scene, hit, -ray_.direction / unit, state_);
    if (word_.length == 0) describe(hit, shading, hit.distance);

    // Its own light.
    if (max_component(shading.emission) > 0 && !is_gathered(word_)) {
        const float pdf = origin_.pdf > 0 ? pass_.lights.triangle_pdf(origin_.position, hit) : 0;
        word_.buffer(sample_) += throughput_ * shading.emission * weight(pass_.lights.triangles_source(), pdf);
    }
    if (word_.length == 0) sample_.alpha -= average(throughput_) * shading.holdout;

    // The light it scatters: from the lights, and from the photons.
    if (word_.length <= pass_.max_bounces && !shading.closures.empty()) {
        plan(hit, shading);
        const bool is_diffuse = (lobes_of(shading) & diffuse_lobes) != 0;
        if (ends_final_gather()) {
            if (is_diffuse) gather_all(hit, shading);
        } else {
            if (!pass_.lights.empty()) sample_lights(hit, shading);
            if (pass_.maps && is_diffuse) gather(hit, shading);
        }
    } else {
        plan(hit, shading);
        go_on_ = {};
    }
    return go_on(hit, shading);
}

void CameraPath::add_lamps(const SurfacePoint *hit) {
    if (is_gathered(word_)) return;
    // Lamps hide nothing: light from behind passes them.
    Ray way = ray_;
    if (hit) way.far = hit->distance;
    pass_.lights.meet_all(way, !hit, [&](const LampHit &lamp) {
        // Light sampling would have found it from the origin, which may lie before transparent surfaces.
        float pdf = lamp.pdf;
        if (origin_.pdf > 0) {
            const Ray drawn{origin_.position, ray_.direction, 0, infinity, ray_.kinds};
            if (const auto there = pass_.lights.meet(lamp.source, drawn, true)) pdf = there->pdf;
        }
        word_.buffer(sample_) += throughput_ * lamp.radiance * weight(lamp.source, pdf);
    });
}

void CameraPath::add_world() {
    const Vec3 direction = normalize(ray_.direction);
    if (word_.length == 0 && pass_.film_transparent) {
        sample_.alpha -= average(throughput_);
        return;
    }
    if (!(pass_.lights.world_visibility() & ray_.kinds) || is_gathered(word_)) return;
    const Vec3 radiance = pass_.lights.world_radiance(direction, state_);
    const float pdf = origin_.pdf > 0 ? pass_.lights.world_pdf(direction, origin_.normal, origin_.both_sides) : 0;
    Vec3 &buffer = word_.length == 0 ? sample_.background : word_.buffer(sample_);
    buffer += throughput_ * radiance * weight(pass_.lights.world_source(), pdf);
}

/// What is told of the first surface that hides most of what is behind it.
void CameraPath::describe(const SurfacePoint &hit, const Shading &shading, float depth) {
    constexpr float mostly = 0.5f;
    if (is_described_ || average(shading.transparency) > mostly) return;
    is_described_ = true;
    sample_.depth = first_depth_ + depth;
    sample_.position = hit.position;
    sample_.normal = hit.shading_normal;
    sample_.albedo = min(albedo(shading, all_lobes), {1, 1, 1});
}

/// What the photons bring to a surface that the eye sees: but for a final gather, all but the lights' own.
void CameraPath::gather(const SurfacePoint &hit, const Shading &shading) {
    if (asks_emitters() && pass_.lights.has_emissive_triangles()) meet_emitters(hit, shading);
    const bool by_rough = pass_.gathers_rough && word_.diffuse == 0 && !word_.is_rough;
    const Lobes lobes = by_rough ? diffuse_lobes | rough_reflection : diffuse_lobes;
    if (levels_ && word_.diffuse == 0)
        add_caustic_levels(hit, shading, lobes);
    else
        add_photons(pass_.maps->caustic, hit, shading, lobes, glossy_part);
    if (pass_.indirect == Indirect::photons) add_photons(pass_.maps->global, hit, shading, diffuse_lobes, diffuse_part);
}

/// All the light of a surface that a final gather met.
void CameraPath::gather_all(const SurfacePoint &hit, const Shading &shading) {
    add_photons(pass_.maps->caustic, hit, shading, diffuse_lobes, glossy_part);
    add_photons(pass_.maps->global, hit, shading, diffuse_lobes, diffuse_part);
}

/// @param lobes by which the surface shows the photons
/// @param last the scattering after which the photons came
void CameraPath::add_photons(const PhotonGather &map, const SurfacePoint &hit, const Shading &shading, Lobes lobes,
                             Part last) {
    ++counts_.estimates;
    const Gathered gathered = gather_radiance(map, hit, shading, lobes);
    word_.then(diffuse_part).then(last).buffer(sample_) += throughput_ * gathered.radiance;
    sample_.photon_density += average(throughput_) * gathered.density;
    if (!is_probe_) return;
    MapSample &sample = &map == &pass_.maps->caustic ? sample_.caustic_map : sample_.global;
    sample.radiance += throughput_ * gathered.radiance;
    sample.blur += throughput_ * (gathered.radiance - gather_radiance(halved(map), hit, shading, lobes).radiance);
}

/// What the caustic map brings to what the eye sees, by all radii.
/// @param lobes by which the surface shows the photons
void CameraPath::add_caustic_levels(const SurfacePoint &hit, const Shading &shading, Lobes lobes) {
    ++counts_.estimates;
    const Levels gathered = throughput_ * gather_levels(pass_.maps->caustic, hit, shading, lobes);
    *levels_ += gathered;
    sample_.caustic += gathered.color(provisional_level);
    if (is_probe_) sample_.caustic_map.radiance += gathered.color(provisional_level);
    sample_.photon_density += average(throughput_) * gathered.density;
}

/// Shares the ways to go on by what they bring.
void CameraPath::plan(const SurfacePoint &hit, const Shading &shading) {
    const float straight = average(shading.transparency);
    parts_ = parts_of(shading, pass_.has_caustics);
    const float diffuse = goes_on_diffusely() ? average(albedo(shading, parts_[diffuse_part])) : 0;
    const float rough = average(albedo(shading, parts_[rough_part]));
    const float reflected = average(albedo(shading, parts_[glossy_part] & reflection_lobes));
    const float transmitted = average(albedo(shading, parts_[glossy_part] & transmissive_lobes));
    const float sum = straight + diffuse + rough + reflected + transmitted;
    const float scale = sum > 0 ? 1 / sum : 0;
    go_straight_ = straight * scale;
    go_on_ = {diffuse * scale, rough * scale, (reflected + transmitted) * scale};
    splits_ = word_.length < whole_scatterings && reflected > 0 && transmitted > 0;
    guide_.reset();
    if (!pass_.importance || go_on_[diffuse_part] <= 0) return;
    const auto u = sequence_.next();
    if (const IncomingFlux *incoming = pass_.importance->around(hit, u[0], u[1])) guide_.emplace(*incoming, shading);
}

/// A direction in which the path goes on.
std::optional<ScatterSample> CameraPath::draw(const SurfacePoint &hit, const Shading &shading, Lobes lobes,
                                              const std::array<float, 3> &u) const {
    if (guide_ && (lobes & diffuse_lobes)) return sample_guided(*guide_, shading, u);
    return sample(shading, lobes, u, transport(hit));
}

bool CameraPath::go_on(const SurfacePoint &hit, const Shading &shading) {
    if (go_straight_ + go_on_[diffuse_part] + go_on_[rough_part] + go_on_[glossy_part] <= 0) return false;
    const auto u = sequence_.next();
    if (u[3] < go_straight_) return pass_straight(hit, shading, u[3] / go_straight_);

    // By one of the parts; by the last that is possible, whatever the rounding.
    float left = u[3] - go_straight_;
    std::optional<Part> part;
    for (const Part next : {glossy_part, rough_part, diffuse_part}) {
        if (go_on_[next] <= 0) continue;
        if (part) left -= go_on_[*part];
        part = next;
        if (left < go_on_[next]) break;
    }
    if (!part) return false;
    const std::array<float, 4> rest{u[0], u[1], u[2], left / go_on_[*part]};
    if (*part != glossy_part || !splits_) return scatter(hit, shading, *part, parts_[*part], rest);
    CameraPath reflected = *this;
    reflected.sequence_ = sequence_.branch();
    if (reflected.scatter(hit, shading, glossy_part, parts_[glossy_part] & reflection_lobes, rest)) reflected.follow();
    return scatter(hit, shading, glossy_part, parts_[glossy_part] & transmissive_lobes, rest);
}

/// Goes on through a transparent surface.
/// @param u in [0, 1), for the roulette
bool CameraPath::pass_straight(const SurfacePoint &hit, const Shading &shading, float u) {
    throughput_ *= shading.transparency / go_straight_;
    if (state_.transparent_depth == max_transparent_depth || !survives(throughput_, u)) return false;
    if (!is_described_) first_depth_ += hit.distance;
    state_ = passed(state_);
    // The ray's own density and origin stay: it is still the one that was drawn there.
    ray_.origin = hit.origin_towards(ray_.direction);
    ray_.near = 0;
    ray_.far -= hit.distance;
    return true;
}

/// Goes on by some lobes of a part that was chosen.
/// @param u in [0, 1), the last for the roulette
bool CameraPath::scatter(const SurfacePoint &hit, const Shading &shading, Part part, Lobes lobes,
                         const std::array<float, 4> &u) {
    const auto drawn = draw(hit, shading, lobes, {u[0], u[1], u[2]});
    if (!drawn) return false;
    if (drawn->lobe == glossy_transmission && pass_.scene.mesh_of(hit).is_closed) {
        if (!hit.is_backfacing)
            ++bodies_;
        else if (bodies_ > 0)
            --bodies_;
    }
    throughput_ *= drawn->weight / go_on_[part];
    if (!survives(throughput_, u[3])) return false;
    origin_ = {drawn->is_singular ? 0 : go_on_[part] * drawn->pdf, hit.position, hit.shading_normal,
               (lobes_of(shading) & transmissive_lobes) != 0, asks_every_source()};
    word_ = word_.then(part);
    state_ = scattered(state_, *drawn);
    ray_ = {hit.origin_towards(drawn->direction), drawn->direction};
    ray_.kinds = visible_kind(drawn->lobe);
    return true;
}

/// Russian roulette; the density of a ray that survives is not changed, so that it weighs as it was drawn.
bool CameraPath::survives(Vec3 weight, float u) {
    const float survival = std::min(1.0f, roulette_scale * max_component(weight));
    if (!(u < survival)) return false;
    throughput_ = throughput_ / survival;
    return true;
}

PixelSample trace_camera_path(const CameraPass &pass, const Ray &ray, bool is_probe, const Sequence &sequence,
                              RayCounts &counts, Levels *levels) {
    PixelSample sample;
    CameraPath(pass, ray, is_probe, sequence, counts, levels, sample).follow();
    return sample;
}

}  // namespace photon_maps
