// SPDX-License-Identifier: GPL-3.0-or-later
// What surface.h adds against closed forms, and with input that is not fit for any.
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "surface_checks.h"

using namespace photon_maps;
using namespace photon_maps::test;

namespace {

constexpr std::array<float, 3> middle{0.5f, 0.5f, 0.5f}, last{0.5f, 0.5f, 0.9999f};

Vec3 towards(float cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

void check_color(Checks &checks, Vec3 found, Vec3 expected, float tolerance, const std::string &what) {
    for (int axis = 0; axis < 3; ++axis)
        checks.near(double{found[axis]}, double{expected[axis]}, double{tolerance}, what);
}

/// The weight of a mirror's only direction.
Vec3 mirrored(const Shading &shading) {
    const auto drawn = sample(shading, all_lobes, middle, Transport::flux);
    return drawn && drawn->is_singular ? drawn->weight : Vec3{-1, -1, -1};
}

void check_lambert(Checks &checks) {
    Shading shading = seen(towards(0.3f));
    add_diffuse(shading, orange, 0, up);
    const Vec3 incoming = towards(0.6f);
    check_color(checks, evaluate(shading, all_lobes, incoming, Transport::radiance), orange * (0.6f / pi), 1e-6f,
                "Lambert: colour cos / pi");
    checks.near(double{pdf(shading, all_lobes, incoming)}, double{0.6f / pi}, 1e-6, "Lambert: density");
    check_color(checks, albedo(shading, all_lobes), orange, 0, "Lambert: albedo");
    check_color(checks, albedo(shading, glossy_lobes), {}, 0, "Lambert: nothing is glossy");
    check_color(checks, evaluate(shading, all_lobes, -incoming, Transport::radiance), {}, 0, "Lambert: not below");
    check_color(checks, evaluate(shading, glossy_lobes, incoming, Transport::radiance), {}, 0, "Lambert: not glossy");
    checks.that(!sample(shading, glossy_lobes, middle, Transport::flux), "Lambert: no glossy samples");
    checks.that(lobes_of(shading) == diffuse_reflection, "Lambert: its lobe");
}

void check_rough_lobes(Checks &checks) {
    const auto lobes_at = [](float roughness, auto add) {
        Shading shading = seen(towards(0.3f));
        add(shading, roughness);
        return lobes_of(shading);
    };
    const auto glossy = [](Shading &shading, float roughness) { add_glossy(shading, white, roughness, up, true); };
    const auto glass = [](Shading &shading, float roughness) {
        add_glass(shading, white, white, roughness, 1.5f, up, true);
    };
    checks.that(lobes_at(0.2f, glossy) == glossy_reflection, "a narrow reflection");
    checks.that(lobes_at(0.25f, glossy) == rough_reflection, "a rough reflection");
    checks.that(lobes_at(0.9f, glass) == (glossy_reflection | glossy_transmission), "glass is never rough in that way");

    Shading coated = seen(towards(0.3f));
    add_glossy(coated, white * 0.5f, 0.1f, up, true);
    add_glossy(coated, orange * 0.5f, 0.5f, up, true);
    const Vec3 incoming = towards(0.6f);
    check_color(checks,
                evaluate(coated, glossy_reflection, incoming, Transport::radiance) +
                    evaluate(coated, rough_reflection, incoming, Transport::radiance),
                evaluate(coated, glossy_lobes, incoming, Transport::radiance), 1e-6f, "both are the whole");
    const auto drawn = sample(coated, rough_reflection, middle, Transport::radiance);
    checks.that(drawn && drawn->lobe == rough_reflection, "a sample of the rough one alone");
}

void check_metals(Checks &checks) {
    const Vec3 tint{0.6f, 0.9f, 0.3f};
    Shading head_on = seen(up), grazing = seen(towards(1.0f / 7));
    add_metallic(head_on, white, orange, tint, 0, up, true);
    add_metallic(grazing, white, orange, tint, 0, up, true);
    check_color(checks, mirrored(head_on), orange, 1e-5f, "F82: its colour head on");
    const float schlick = std::pow(6.0f / 7, 5.0f);
    check_color(checks, mirrored(grazing), (orange * (1 - schlick) + white * schlick) * tint, 1e-5f,
                "F82: Schlick's reflectance times the tint at 82 degrees");

    const float n = 0.2f, k = 3.9f;
    Shading silver = seen(up);
    add_conductor(silver, white, white * n, white * k, 0, up, false);
    check_color(checks, mirrored(silver), white * (((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k)), 1e-5f,
                "conductor: head on");
    Shading dielectric = seen(towards(1 / std::sqrt(1 + 1.5f * 1.5f)));  // Brewster's angle
    add_conductor(dielectric, white, white * 1.5f, {}, 0, up, false);
    const float perpendicular = (1 - 1.5f * 1.5f) / (1 + 1.5f * 1.5f);
    check_color(checks, mirrored(dielectric), white * (perpendicular * perpendicular / 2), 1e-5f,
                "conductor without extinction: half of the light is not reflected at Brewster's angle");
}

void check_smooth_glass(Checks &checks) {
    Shading glass = seen(towards(0.6f));
    add_glass(glass, white, white, 0, 1.5f, up, true);
    const auto refracted = sample(glass, all_lobes, last, Transport::flux);
    checks.that(refracted && refracted->is_singular && refracted->lobe == glossy_transmission, "glass refracts");
    if (refracted) {
        checks.near(double{refracted->direction.x}, -0.8 / 1.5, 1e-6, "Snell's law");
        check_color(checks, refracted->weight, white, 1e-5f, "glass loses nothing");
        const auto radiance = sample(glass, all_lobes, last, Transport::radiance);
        check_color(checks, radiance->weight, white / 2.25f, 1e-5f, "radiance in glass is denser");
    }
    Shading head_on = seen(up);
    add_glass(head_on, white, white, 0, 1.5f, up, true);
    const auto transmitted = sample(head_on, glossy_transmission, middle, Transport::flux);
    checks.that(transmitted.has_value(), "glass asked for refraction alone");
    if (transmitted) check_color(checks, transmitted->weight, white * 0.96f, 1e-5f, "4 % are reflected head on");
    check_color(checks, evaluate(head_on, all_lobes, -up, Transport::flux), {}, 0, "smooth glass is singular");

    Shading inside = seen(towards(0.6f), true);  // beyond the critical angle, whose cosine is 0.745
    add_glass(inside, white, white, 0, 1.5f, up, true);
    add_refraction(inside, white, 0, 1.5f, up);
    const auto total = sample(inside, all_lobes, last, Transport::flux);
    checks.that(total && total->lobe == glossy_reflection, "total reflection");
    if (total) check_color(checks, total->weight, white, 1e-5f, "total reflection loses nothing");

    for (const float roughness : {0.0f, 0.3f, 1.0f}) {
        Shading air = seen(towards(0.2f));
        add_glass(air, white, white, roughness, 1, up, true);
        const auto straight = sample(air, all_lobes, middle, Transport::radiance);
        checks.that(straight && straight->is_singular, "glass of index 1 does not scatter");
        if (!straight) continue;
        check_color(checks, straight->direction, -air.outgoing, 1e-6f, "glass of index 1 is invisible");
        check_color(checks, straight->weight, white, 1e-5f, "glass of index 1 is clear");
    }
}

/// Bumps: the masking of GGX with alpha^2 = tan^2 / 8 of the angle between the normals.
void check_bump_shadowing(Checks &checks) {
    Shading shading = seen(towards(0.9f));
    const Vec3 normal = towards(0.8f), incoming = towards(0.6f);
    add_diffuse(shading, orange, 0, normal);
    const Vec3 open = evaluate(shading, all_lobes, incoming, Transport::radiance);
    check_color(checks, open, orange * (dot(normal, incoming) / pi), 1e-6f, "without a smooth normal: none");
    shading.smooth_normal = normal;
    check_color(checks, evaluate(shading, all_lobes, incoming, Transport::radiance), open, 1e-6f,
                "where the closure has the smooth normal: none");
    shading.smooth_normal = -normal;
    check_color(checks, evaluate(shading, all_lobes, incoming, Transport::radiance), open, 1e-6f,
                "nor where it was turned to the side that is seen");
    shading.smooth_normal = up;
    const float alpha_squared = 0.75f * 0.75f / 8, tangent_squared = 1 / (0.6f * 0.6f) - 1;
    check_color(checks, evaluate(shading, all_lobes, incoming, Transport::radiance),
                open * (2 / (1 + std::sqrt(1 + alpha_squared * tangent_squared))), 1e-5f, "bumps mask light");
}

Shading add(const Principled &inputs, Vec3 outgoing = up) {
    Shading shading = seen(outgoing);
    add_principled(shading, white, inputs, true);
    return shading;
}

void check_principled(Checks &checks) {
    Principled inputs = plain_principled(orange, 0.5f, up);
    inputs.specular_level = 0;
    check_color(checks, albedo(add(inputs), all_lobes), orange, 1e-6f, "without a specular layer: Lambert");
    inputs = plain_principled(orange, 0.5f, up);
    inputs.roughness = 0;
    check_color(checks, albedo(add(inputs), all_lobes), white * 0.04f + orange * 0.96f, 1e-4f,
                "a smooth layer leaves 96 % head on");
    inputs.metallic = 1;
    check_color(checks, albedo(add(inputs), all_lobes), orange, 1e-5f, "metal");
    inputs = plain_principled(orange, 0.5f, up);
    inputs.alpha = 0.25f;
    check_color(checks, add(inputs).transparency, white * 0.75f, 1e-6f, "alpha is transparency");
    inputs.emission = {1, 2, 4};
    check_color(checks, add(inputs).emission, inputs.emission * 0.25f, 1e-6f, "emission is under alpha");
    inputs.alpha = inputs.coat = 1;
    inputs.coat_tint = {0.5f, 1, 0};
    check_color(checks, add(inputs).emission, inputs.emission * inputs.coat_tint * 0.96f, 1e-3f,
                "emission is under the coat");
    inputs = plain_principled(orange, 0.5f, up);
    inputs.transmission = 1;
    inputs.roughness = 0;
    const auto refracted = sample(add(inputs), all_lobes, last, Transport::flux);
    checks.that(refracted && refracted->lobe == glossy_transmission, "transmission refracts");
    if (refracted)
        check_color(checks, refracted->weight / refracted->weight.x,
                    {1, std::sqrt(0.5f / 0.8f), std::sqrt(0.2f / 0.8f)}, 1e-4f,
                    "one of two passages has the root of the colour");
}

/// No input makes a direction, weight or density that is not a number.
void check_unfit_input(Checks &checks) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> values{0, 1, -1, 2, 1e-6f, 1e30f, nan, infinity, -infinity};
    const std::vector<Vec3> normals{
        up, -up, {1, 0, 0}, {}, white * nan, Vec3{0.6f, 0, 0.8f}, Vec3{-0.999f, 0, -0.0447f}};
    for (const Vec3 outgoing : {up, towards(1e-6f), towards(0), towards(0.3f)})
        for (const bool is_backfacing : {false, true})
            for (const float value : values)
                for (const Vec3 normal : normals) {
                    Principled inputs = plain_principled(orange, 0.5f, up);
                    inputs.metallic = inputs.roughness = inputs.ior = inputs.transmission = inputs.coat = inputs.sheen =
                        inputs.coat_ior = inputs.sheen_roughness = inputs.diffuse_roughness = inputs.specular_level =
                            value;
                    inputs.base_color = inputs.emission = inputs.coat_tint = white * value;
                    inputs.normal = inputs.coat_normal = normal;
                    Shading all = seen(outgoing, is_backfacing);
                    add_principled(all, white, inputs, true);
                    checks.that(is_finite(all.emission) || !std::isfinite(value), "emission is finite");
                    Shading other = seen(outgoing, is_backfacing);
                    add_diffuse(other, white * value, value, normal);
                    add_translucent(other, white * value, normal);
                    add_sheen(other, white, value, normal);
                    add_glossy(other, white, value, normal, true);
                    add_conductor(other, white, white * value, white * value, value, normal, true);
                    add_metallic(other, white, white * value, white * value, 0.5f, normal, true);
                    add_glass(other, white, white * value, 0.5f, value, normal, true);
                    add_glass(other, white, white, value, 1.5f, normal, true);
                    add_refraction(other, white, value, value, normal);
                    for (const Shading &shading : {all, other}) {
                        checks.that(is_finite(albedo(shading, all_lobes)), "albedo is finite");
                        for (int i = 0; i < 16; ++i) {
                            const float u = static_cast<float>(i) / 16;
                            const float v = static_cast<float>(i * 7 % 16) / 16,
                                        w = static_cast<float>(i * 5 % 16) / 16;
                            const auto drawn = sample(shading, all_lobes, {u, v, w}, Transport::radiance);
                            checks.that(!drawn || (is_finite(drawn->direction) && is_finite(drawn->weight) &&
                                                   std::isfinite(drawn->pdf)),
                                        "samples are finite");
                            const Vec3 incoming = towards(v) * (i % 2 ? 1.0f : -1.0f);
                            checks.that(is_finite(evaluate(shading, all_lobes, incoming, Transport::flux)) &&
                                            std::isfinite(pdf(shading, all_lobes, incoming)),
                                        "values are finite");
                        }
                    }
                }
    Shading full = seen(up);
    for (size_t i = 0; i < max_closures + 3; ++i) add_diffuse(full, orange, 0, up);
    checks.that(full.closures.size() == max_closures, "further closures are dropped");
    Shading none = seen(up);
    add_diffuse(none, {-1, nan, 0}, 0, up);
    checks.that(none.closures.empty(), "closures without weight are dropped");
}

}  // namespace

int main() {
    Checks checks;
    check_lambert(checks);
    check_rough_lobes(checks);
    check_metals(checks);
    check_smooth_glass(checks);
    check_bump_shadowing(checks);
    check_principled(checks);
    check_unfit_input(checks);
    return checks.report();
}
