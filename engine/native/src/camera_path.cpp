// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera_path.h"

#include "mis.h"
#include "path_word.h"
#include "ray_state.h"

namespace photon_maps {

namespace {

/// What the eye sees directly, in mirrors or through glass asks every source while they are few: choosing among them
/// costs more in noise than the rays saved are worth.
constexpr size_t few_sources = 8;

/// A path whose throughput times this is below 1 plays Russian roulette: glossy reflections on plastics bring little,
/// and cost as much as all the rest of their pixel.
constexpr float roulette_scale = 8;

class CameraPath {
  public:
    CameraPath(const CameraPass &pass, Sequence &sequence, uint64_t &rays)
        : pass_(pass), sequence_(sequence), rays_(rays) {}

    PixelSample trace(const Ray &ray) {
        ray_ = ray;
        state_.kinds = ray_.kinds = 1u << PM_RAY_CAMERA;
        while (step()) {
        }
        return sample_;
    }

  private:
    /// Where the current ray was drawn: what light sampling would have done there instead.
    struct Origin {
        float pdf = 0;  ///< of the ray; 0: only this ray could bring that light
        Vec3 position, normal;
        bool both_sides = false, asked_all = false;
    };

    bool step();
    void add_lamps(const SurfacePoint *hit);
    void add_world();
    void describe(const SurfacePoint &hit, const Shading &shading, float depth);
    void sample_lights(const SurfacePoint &hit, const Shading &shading);
    void sample_source(const SurfacePoint &hit, const Shading &shading, const Lights::Choice &choice,
                       const std::array<float, 4> &u);
    RayState receiver(const Shading &shading) const;
    float other_pdf(const Shading &shading, Lobes lobes, size_t source, Vec3 direction) const;
    void meet_emitters(const SurfacePoint &hit, const Shading &shading);
    void gather(const SurfacePoint &hit, const Shading &shading);
    void plan(const Shading &shading);
    bool go_on(const SurfacePoint &hit, const Shading &shading);
    bool survives(Vec3 weight, float u);
    Transport transport(const SurfacePoint &hit) const {
        const bool began_inside = hit.is_backfacing && bodies_ == 0;
        return pass_.scene.mesh_of(hit).is_closed && !began_inside ? Transport::radiance : Transport::flux;
    }

    bool asks_every_source() const { return word_.diffuse == 0 && pass_.lights.source_count() <= few_sources; }
    /// Weight of light that the current ray meets, against light sampling at its origin.
    float weight(size_t source, float light_pdf) const {
        if (origin_.pdf == 0) return 1;
        const float choice = origin_.asked_all ? 1 : pass_.lights.choice_probability(source, origin_.position);
        return power_heuristic(origin_.pdf, choice * light_pdf);
    }

    const CameraPass &pass_;
    Sequence &sequence_;
    uint64_t &rays_;
    PixelSample sample_;
    Ray ray_;
    RayState state_;
    Vec3 throughput_{1, 1, 1};
    Word word_;
    uint32_t bodies_ = 0;  ///< that the path entered and has not left
    Origin origin_;
    bool is_described_ = false;
    float first_depth_ = 0;  ///< of the transparent surfaces passed so far, along the camera's ray
    /// Probabilities of the three ways to go on from the present vertex.
    float go_diffuse_ = 0, go_glossy_ = 0, go_straight_ = 0;
};

bool CameraPath::step() {
    // What the ray meets: lamps on the way, a surface or the world.
    SurfacePoint hit;
    ++rays_;
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
    if (max_component(shading.emission) > 0) {
        const float pdf = origin_.pdf > 0 ? pass_.lights.triangle_pdf(origin_.position, hit) : 0;
        word_.buffer(sample_) += throughput_ * shading.emission * weight(pass_.lights.triangles_source(), pdf);
    }
    if (word_.length == 0) sample_.alpha -= average(throughput_) * shading.holdout;

    // The light it scatters: from the lights, and from the photons.
    if (word_.length <= pass_.max_bounces && !shading.closures.empty()) {
        plan(shading);
        if (!pass_.lights.empty()) sample_lights(hit, shading);
        if (pass_.maps && (lobes_of(shading) & diffuse_lobes)) {
            if (pass_.lights.has_emissive_triangles()) meet_emitters(hit, shading);
            gather(hit, shading);
        }
    } else {
        plan(shading);
        go_diffuse_ = go_glossy_ = 0;
    }
    return go_on(hit, shading);
}

void CameraPath::add_lamps(const SurfacePoint *hit) {
    // Lamps hide nothing: light from behind passes them.
    Ray way = ray_;
    if (hit) way.far = hit->distance;
    pass_.lights.meet_all(way, !hit, [&](const LampHit &lamp) {
        // Light sampling would have found it from the origin, which may lie before transparent surfaces.
        float pdf = lamp.pdf;
        if (origin_.pdf > 0) {
            constexpr float infinity = std::numeric_limits<float>::infinity();
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
    if (!(pass_.lights.world_visibility() & ray_.kinds)) return;
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

void CameraPath::sample_lights(const SurfacePoint &hit, const Shading &shading) {
    if (asks_every_source()) {
        for (size_t source = 0; source < pass_.lights.source_count(); ++source) {
            if (!pass_.lights.shines(source)) continue;
            const auto u = sequence_.next();
            sample_source(hit, shading, {source, 1, u[2]}, u);
        }
    } else {
        const auto u = sequence_.next();
        if (const auto choice = pass_.lights.choose(hit.position, u[2])) sample_source(hit, shading, *choice, u);
    }
}

void CameraPath::sample_source(const SurfacePoint &hit, const Shading &shading, const Lights::Choice &choice,
                               const std::array<float, 4> &u) {
    const bool both_sides = (lobes_of(shading) & transmissive_lobes) != 0;
    const auto light = pass_.lights.sample(choice.source, hit.position, hit.shading_normal, both_sides,
                                           receiver(shading), {u[0], u[1], choice.left});
    if (!light) return;
    const bool transmits = dot(light->direction, hit.normal) < 0;
    std::array<Vec3, 2> scattered;
    const std::array<Lobes, 2> parts = {diffuse_lobes, glossy_lobes};
    for (size_t part = 0; part < 2; ++part) {
        const Lobe lobe = part == 0 ? (transmits ? diffuse_transmission : diffuse_reflection)
                                    : (transmits ? glossy_transmission : glossy_reflection);
        if (!(light->visibility & visible_kind(lobe))) continue;
        scattered[part] = evaluate(shading, parts[part], light->direction, transport(hit));
        if (max_component(scattered[part]) <= 0) continue;
        const float other = light->pdf > 0 ? other_pdf(shading, parts[part], choice.source, light->direction) : 0;
        const float mis = other > 0 ? power_heuristic(light->pdf * choice.probability, other) : 1;
        scattered[part] = scattered[part] * (mis / choice.probability);
    }
    if (max_component(scattered[0] + scattered[1]) <= 0) return;
    const Ray shadow{hit.origin_towards(light->direction), light->direction, 0, light->distance};
    const Vec3 arriving = throughput_ * light->radiance * pass_.scene.transmittance(shadow, rays_);
    for (size_t part = 0; part < 2; ++part) word_.then(parts[part]).buffer(sample_) += scattered[part] * arriving;
}

/// The state of rays that would come to a light instead of light sampling.
RayState CameraPath::receiver(const Shading &shading) const {
    RayState state = state_;
    state.kinds = 0;
    ++state.depth;
    for (const Lobe lobe : {diffuse_reflection, diffuse_transmission, glossy_reflection, glossy_transmission})
        if (lobes_of(shading) & lobe) state.kinds |= ray_kinds(lobe);
    return state;
}

/// Density with which a ray by these lobes will go in a direction to meet a source.
float CameraPath::other_pdf(const Shading &shading, Lobes lobes, size_t source, Vec3 direction) const {
    float probability = lobes == glossy_lobes ? go_glossy_ : go_diffuse_;
    if (pass_.maps && lobes == diffuse_lobes) probability = source == pass_.lights.triangles_source() ? 1 : 0;
    return probability > 0 ? probability * pdf(shading, lobes, direction) : 0;
}

/// A ray by the diffuse closures that counts only if it meets an emissive surface: photons bring the rest.
void CameraPath::meet_emitters(const SurfacePoint &hit, const Shading &shading) {
    const auto u = sequence_.next();
    const auto drawn = sample(shading, diffuse_lobes, {u[0], u[1], u[2]}, Transport::radiance);
    if (!drawn) return;
    RayState state = scattered(state_, *drawn);
    Ray ray{hit.origin_towards(drawn->direction), drawn->direction};
    ray.kinds = visible_kind(drawn->lobe);
    Vec3 reached = throughput_ * drawn->weight;
    SurfacePoint next;
    for (; state.transparent_depth < max_transparent_depth; state = passed(state)) {
        ++rays_;
        if (!pass_.scene.intersect(ray, next)) return;
        state.length += next.distance;
        if (!next.material->traits.emits && !next.material->traits.is_transparent) return;
        const Shading there = shade(pass_.scene, next, -ray.direction, state);
        if (max_component(there.emission) > 0) {
            const size_t source = pass_.lights.triangles_source();
            const float choice = asks_every_source() ? 1 : pass_.lights.choice_probability(source, hit.position);
            const float light_pdf = choice * pass_.lights.triangle_pdf(hit.position, next);
            word_.then(diffuse_lobes).buffer(sample_) +=
                reached * there.emission * power_heuristic(drawn->pdf, light_pdf);
        }
        reached *= there.transparency;
        if (max_component(reached) <= 0) return;
        ray.origin = next.origin_towards(ray.direction);
    }
}

void CameraPath::gather(const SurfacePoint &hit, const Shading &shading) {
    const Gathered indirect = gather_radiance(pass_.maps->indirect, hit, shading);
    const Gathered caustic = gather_radiance(pass_.maps->caustic, hit, shading);
    sample_.indirect += throughput_ * indirect.radiance;
    sample_.caustic += throughput_ * caustic.radiance;
    sample_.photon_density += average(throughput_) * (indirect.density + caustic.density);
}

/// Shares the ways to go on by what they bring.
void CameraPath::plan(const Shading &shading) {
    const float straight = average(shading.transparency);
    const float glossy = average(albedo(shading, glossy_lobes));
    const float diffuse = pass_.maps ? 0 : average(albedo(shading, diffuse_lobes));
    const float sum = straight + glossy + diffuse;
    const float scale = sum > 0 ? 1 / sum : 0;
    go_straight_ = straight * scale;
    go_glossy_ = glossy * scale;
    go_diffuse_ = diffuse * scale;
}

bool CameraPath::go_on(const SurfacePoint &hit, const Shading &shading) {
    if (go_straight_ + go_glossy_ + go_diffuse_ <= 0) return false;
    const auto u = sequence_.next();
    const bool is_straight = u[3] < go_straight_;
    if (is_straight) {
        throughput_ *= shading.transparency / go_straight_;
        if (state_.transparent_depth == max_transparent_depth || !survives(throughput_, u[3] / go_straight_))
            return false;
        if (!is_described_) first_depth_ += hit.distance;
        state_ = passed(state_);
        // The ray's own density and origin stay: it is still the one that was drawn there.
        ray_.origin = hit.origin_towards(ray_.direction);
        ray_.near = 0;
        ray_.far -= hit.distance;
        return true;
    }
    const bool is_glossy = u[3] < go_straight_ + go_glossy_ || go_diffuse_ <= 0;
    const Lobes lobes = is_glossy ? glossy_lobes : diffuse_lobes;
    const float chosen = is_glossy ? go_glossy_ : go_diffuse_;
    const float left = (u[3] - go_straight_ - (is_glossy ? 0 : go_glossy_)) / chosen;
    const auto drawn = chosen > 0 ? sample(shading, lobes, {u[0], u[1], u[2]}, transport(hit)) : std::nullopt;
    if (!drawn) return false;
    if (drawn->lobe == glossy_transmission && pass_.scene.mesh_of(hit).is_closed) {
        if (!hit.is_backfacing)
            ++bodies_;
        else if (bodies_ > 0)
            --bodies_;
    }
    throughput_ *= drawn->weight / chosen;
    if (!survives(throughput_, left)) return false;
    origin_ = {drawn->is_singular ? 0 : chosen * drawn->pdf, hit.position, hit.shading_normal,
               (lobes_of(shading) & transmissive_lobes) != 0, asks_every_source()};
    word_ = word_.then(lobes);
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

}  // namespace

PixelSample trace_camera_path(const CameraPass &pass, const Ray &ray, Sequence &sequence, uint64_t &rays) {
    return CameraPath(pass, sequence, rays).trace(ray);
}

}  // namespace photon_maps
