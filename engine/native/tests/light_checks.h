// SPDX-License-Identifier: GPL-3.0-or-later
// Compares how a light is sampled with what rays that meet it are told.
#pragma once

#include <cstdlib>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "check.h"
#include "light.h"
#include "photon_maps_shader.h"
#include "sampling.h"
#include "sequence.h"

namespace photon_maps::test {

constexpr double pi_double = std::numbers::pi;
constexpr Vec3 up{0, 0, 1};
constexpr uint64_t sample_count = 1 << 18;

inline std::shared_ptr<const Embree> embree() {
    const char *path = std::getenv("PHOTON_MAPS_EMBREE");
    return std::make_shared<const Embree>(path ? path : "");
}

inline RayState ray_of(pm_ray kind) {
    RayState ray;
    ray.kinds = 1u << kind;
    return ray;
}

/// A material that grows: registers are numbered as it goes, so constants come first.
struct Builder {
    Material material;
    uint32_t next = 0;

    uint32_t constant(Vec3 value) {
        material.program.constants.push_back(value);
        return next++;
    }
    uint32_t add(uint32_t op, const std::vector<uint32_t> &arguments, uint32_t option = 0) {
        Program &p = material.program;
        p.instructions.push_back(
            {op, option, 0, next, static_cast<uint32_t>(p.arguments.size()), static_cast<uint32_t>(arguments.size())});
        p.arguments.insert(p.arguments.end(), arguments.begin(), arguments.end());
        return next++;
    }
    /// The material, ready, that emits a register's value.
    Material emitting(uint32_t radiance, const Scene &scene) {
        add(PM_OP_EMISSION, {radiance});
        --next;  // it writes nothing
        material.program.register_count = next;
        prepare(material, scene);
        return material;
    }
};

/// A material that emits the same everywhere.
inline Material emitter(const Scene &scene, Vec3 radiance) {
    Builder builder;
    return builder.emitting(builder.constant(radiance), scene);
}

/// A direction, the density that a ray in it is told, and the radiance that it meets.
struct Seen {
    float pdf = 0;
    Vec3 radiance;
};
using Look = std::function<Seen(Vec3)>;

/// What samples are compared with: the density on a cone of directions, and the irradiance of the plane z = 0.
struct Comparison {
    Vec3 axis = up;
    float one_minus_cosine = 2;
    double irradiance;
    double tolerance = 0.005;  // relative, of the irradiance
};

/// Compares samples with what rays are told: density and radiance of each, the chi-squared statistic over cells of the
/// cone, how many are outside of it, and the irradiance.
inline void check_source(test::Checks &checks, const std::string &name,
                         const std::function<std::optional<LightSample>(std::array<float, 3>)> &draw, const Look &look,
                         const Comparison &expected) {
    constexpr uint32_t rings = 12, sectors = 12, steps = 64;
    const Frame frame(expected.axis);
    std::vector<double> counts(rings * sectors + 1), expectations(rings * sectors + 1);

    // What is drawn.
    double irradiance = 0;
    uint64_t missed = 0, disagreeing = 0, drawn = 0;
    for (uint64_t k = 0; k < sample_count; ++k) {
        const auto u = sobol4(k, 7);
        const std::optional<LightSample> sample = draw({u[0], u[1], u[2]});
        if (!sample) continue;
        ++drawn;
        irradiance +=
            static_cast<double>(average(sample->radiance)) * std::max(0.0, static_cast<double>(sample->direction.z));
        const Vec3 d = sample->direction;
        const Seen seen = look(d);
        if (!(seen.pdf > 0)) {
            ++missed;
        } else {
            const Vec3 difference = sample->radiance * sample->pdf - seen.radiance;
            disagreeing += std::abs(sample->pdf - seen.pdf) > 1e-3f * seen.pdf ||
                           max_component(abs(difference)) > 1e-3f * max_component(seen.radiance);
        }
        const float depth = length_squared(d - expected.axis) / 2 / expected.one_minus_cosine;
        const double phi = std::atan2(static_cast<double>(dot(d, frame.y)), static_cast<double>(dot(d, frame.x)));
        const auto ring = static_cast<uint32_t>(depth * rings);
        const auto sector = std::min(static_cast<uint32_t>((phi / (2 * pi_double) + 0.5) * sectors), sectors - 1);
        ++counts[ring < rings ? ring * sectors + sector : rings * sectors];
    }
    checks.that(static_cast<double>(drawn) > 0.9999 * static_cast<double>(sample_count),
                name + ": nearly all numbers give a direction");
    checks.that(static_cast<double>(missed) < 1e-3 * static_cast<double>(sample_count),
                name + ": what is drawn is met");
    checks.that(static_cast<double>(disagreeing) < 1e-3 * static_cast<double>(sample_count),
                name + ": drawn and met agree on density and radiance");
    checks.near(irradiance / static_cast<double>(sample_count), expected.irradiance,
                expected.tolerance * expected.irradiance, name + ": irradiance");

    // What should be.
    const double cell =
        2 * pi_double * static_cast<double>(expected.one_minus_cosine) / (rings * sectors * steps * steps);
    double total = 0;
    for (uint32_t i = 0; i < rings * steps; ++i) {
        for (uint32_t j = 0; j < sectors * steps; ++j) {
            const float height = expected.one_minus_cosine * (static_cast<float>(i) + 0.5f) / (rings * steps);
            const float phi = 2 * pi * (static_cast<float>(j) + 0.5f) / (sectors * steps) - pi;
            const float sine = std::sqrt(height * (2 - height));
            const Vec3 local{sine * std::cos(phi), sine * std::sin(phi), 1 - height};
            const double own =
                static_cast<double>(look(frame.to_world(local)).pdf) * cell * static_cast<double>(sample_count);
            expectations[i / steps * sectors + j / steps] += own;
            total += own;
        }
    }
    expectations.back() = std::max(0.0, static_cast<double>(sample_count) - total);

    // Sparse cells count together.
    double squared = 0, sparse = 0, sparse_expected = 0;
    int freedom = 0;
    for (size_t c = 0; c < counts.size(); ++c) {
        if (expectations[c] < 40) {
            sparse += counts[c];
            sparse_expected += expectations[c];
            continue;
        }
        squared += (counts[c] - expectations[c]) * (counts[c] - expectations[c]) / expectations[c];
        ++freedom;
    }
    const double limit = freedom + 5 * std::sqrt(2.0 * freedom);
    checks.that(freedom >= 1, name + ": cells are filled");
    checks.near(squared, 0, limit, name + ": chi-squared");
    checks.near(sparse, sparse_expected, 0.002 * static_cast<double>(sample_count), name + ": outside");
}

}  // namespace photon_maps::test
