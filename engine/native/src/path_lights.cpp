// SPDX-License-Identifier: GPL-3.0-or-later
// What the lights bring to a vertex of a camera path.
#include "path_steps.h"

namespace photon_maps {

void CameraPath::sample_lights(const SurfacePoint &hit, const Shading &shading) {
    // Where photons bring the rest, or a path goes on to what is seen less directly.
    const bool is_first = word_.diffuse == 0 && (lobes_of(shading) & diffuse_lobes) != 0;
    const uint32_t count = is_first ? pass_.light_samples : 1;
    const auto sample_each = [&](auto choose) {
        if (is_first) counts_.light_samples += count;
        const Sequence::Points points = sequence_.points(count);
        for (uint32_t i = 0; i < count; ++i) {
            const auto u = points[i];
            if (const std::optional<LightChoice::Choice> choice = choose(u[2]))
                sample_source(hit, shading, *choice, u, 1 / static_cast<float>(count));
        }
    };
    if (!asks_every_source()) {
        const LightChoice::Chances chances = pass_.lights.chances_at(hit.position);
        sample_each([&](float u) { return pass_.lights.choose(chances, u); });
        return;
    }
    for (size_t source = 0; source < pass_.lights.source_count(); ++source)
        if (pass_.lights.shines(source))
            sample_each(
                [&](float u) -> std::optional<LightChoice::Choice> { return LightChoice::Choice{source, 1, u}; });
}

void CameraPath::sample_source(const SurfacePoint &hit, const Shading &shading, const LightChoice::Choice &choice,
                               const std::array<float, 4> &u, float share) {
    const bool both_sides = (lobes_of(shading) & transmissive_lobes) != 0;
    const auto light = pass_.lights.sample(choice.source, hit.position, hit.shading_normal, both_sides,
                                           receiver(shading), {u[0], u[1], choice.left});
    if (!light) return;
    const bool transmits = dot(light->direction, hit.normal) < 0;
    std::array<Vec3, 3> scattered;
    for (const Part part : {diffuse_part, rough_part, glossy_part}) {
        const Lobe lobe = part == diffuse_part ? (transmits ? diffuse_transmission : diffuse_reflection)
                                               : (transmits ? glossy_transmission : glossy_reflection);
        if (!parts_[part] || !(light->visibility & visible_kind(lobe)) || is_gathered(word_.then(part))) continue;
        scattered[part] = evaluate(shading, parts_[part], light->direction, transport(hit));
        if (max_component(scattered[part]) <= 0) continue;
        const float other = light->pdf > 0 ? other_pdf(shading, part, transmits, choice.source, light->direction) : 0;
        const float mis = other > 0 ? power_heuristic(light->pdf * choice.probability, other) : 1;
        scattered[part] = scattered[part] * (share * mis / choice.probability);
    }
    if (max_component(scattered[diffuse_part] + scattered[rough_part] + scattered[glossy_part]) <= 0) return;
    const Ray shadow{hit.origin_towards(light->direction), light->direction, 0, light->distance};
    const Vec3 arriving = throughput_ * light->radiance * transmittance(shadow, hit, choice.source);
    for (const Part part : {diffuse_part, rough_part, glossy_part})
        word_.then(part).buffer(sample_) += scattered[part] * arriving;
}

/// The share of a light's radiance that comes through to a point; without a ray where shadow photons tell.
Vec3 CameraPath::transmittance(const Ray &shadow, const SurfacePoint &hit, size_t source) {
    const Visibility seen =
        pass_.shadow_photons ? pass_.shadow_photons->visibility(hit.position, source) : Visibility::unknown;
    ++(seen == Visibility::unknown ? counts_.shadow_rays : counts_.spared_shadow_rays);
    if (seen == Visibility::unknown) return pass_.scene.transmittance(shadow, counts_.rays);
    return seen == Visibility::lit ? Vec3{1, 1, 1} : Vec3{};
}

/// The state of rays that would come to a light instead of light sampling.
RayState CameraPath::receiver(const Shading &shading) const {
    RayState state = state_;
    state.kinds = 0;
    ++state.depth;
    for (const Lobe lobe : each_lobe)
        if (lobes_of(shading) & lobe) state.kinds |= ray_kinds(lobe);
    return state;
}

/// Density with which a ray by a part will go in a direction to meet a source.
/// @param transmits whether the direction is behind the surface
float CameraPath::other_pdf(const Shading &shading, Part part, bool transmits, size_t source, Vec3 direction) const {
    float probability = go_on_[part];
    if (asks_emitters() && part == diffuse_part) probability = source == pass_.lights.triangles_source() ? 1 : 0;
    if (guide_ && part == diffuse_part) return probability * pdf_guided(*guide_, shading, direction);
    if (!(probability > 0)) return 0;
    Lobes lobes = parts_[part];
    if (part == glossy_part && splits_) lobes &= transmits ? transmissive_lobes : reflection_lobes;
    return probability * pdf(shading, lobes, direction);
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
        ++counts_.rays;
        if (!pass_.scene.intersect(ray, next)) return;
        state.length += next.distance;
        if (!next.material->traits.emits && !next.material->traits.is_transparent) return;
        const Shading there = shade(pass_.scene, next, -ray.direction, state);
        if (max_component(there.emission) > 0) {
            const size_t source = pass_.lights.triangles_source();
            const float choice = asks_every_source() ? 1 : pass_.lights.choice_probability(source, hit.position);
            const float light_pdf = choice * pass_.lights.triangle_pdf(hit.position, next);
            word_.then(diffuse_part).buffer(sample_) +=
                reached * there.emission * power_heuristic(drawn->pdf, light_pdf);
        }
        reached *= there.transparency;
        if (max_component(reached) <= 0) return;
        ray.origin = next.origin_towards(ray.direction);
    }
}

}  // namespace photon_maps
