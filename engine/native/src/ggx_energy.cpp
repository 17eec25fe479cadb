// SPDX-License-Identifier: GPL-3.0-or-later
#include "ggx_energy.h"

#include <vector>

#include "ggx.h"

namespace photon_maps {

namespace {

constexpr size_t fine = 32, coarse = 16;

/// Points of a Fibonacci lattice on the square from which normals are drawn.
constexpr size_t quadrature_points = 377;

/// A position between two rows of a table.
struct Between {
    size_t below, above;
    float share;

    Between(float x, size_t size) {
        const float scaled = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(size - 1);
        below = std::min(static_cast<size_t>(scaled), size - 1);
        above = std::min(below + 1, size - 1);
        share = scaled - static_cast<float>(below);
    }
    float mix(float a, float b) const { return a + (b - a) * share; }
};

/// A table over roughness and cosine.
struct EnergyTable {
    size_t size;
    std::vector<float> values, averages;

    explicit EnergyTable(size_t rows) : size(rows), values(rows * rows), averages(rows) {}
    float &at(size_t rough, size_t cosine) { return values[rough * size + cosine]; }
    float at(size_t rough, size_t cosine) const { return values[rough * size + cosine]; }
    float look_up(float roughness, float cosine) const {
        const Between r(roughness, size), c(cosine, size);
        return r.mix(c.mix(at(r.below, c.below), at(r.below, c.above)),
                     c.mix(at(r.above, c.below), at(r.above, c.above)));
    }
    float look_up_average(float roughness) const {
        const Between r(roughness, size);
        return r.mix(averages[r.below], averages[r.above]);
    }
    /// Integrates 2 cos times the values, which are linear between the quadrature_points.
    void average() {
        const float step = 1 / static_cast<float>(size - 1);
        for (size_t rough = 0; rough < size; ++rough)
            for (size_t i = 0; i + 1 < size; ++i) {
                const float c = static_cast<float>(i) * step, a = at(rough, i), b = at(rough, i + 1);
                averages[rough] += step * (c * (a + b) + step * (a + 2 * b) / 3);
            }
    }
};

float grid_point(size_t index, size_t size) {
    return std::clamp(static_cast<float>(index) / static_cast<float>(size - 1), 1e-4f, 1.0f);
}

/// What a facet does to light from one direction.
struct SampledFacet {
    float weight;      ///< share of the light that it meets
    float cosine;      ///< between the light and its normal
    float height;      ///< cosine of its normal to the surface's
    float reflection;  ///< share of what it reflects that is not shadowed
};

/// Light from one direction on a rough surface.
struct Facets {
    float cosine, alpha;
    std::array<SampledFacet, quadrature_points> facets;

    Facets(size_t rough, size_t direction, size_t size)
        : cosine(grid_point(direction, size)), alpha(square(grid_point(rough, size))) {
        const Vec3 view{std::sqrt(1 - square(cosine)), 0, cosine};
        for (size_t i = 0; i < quadrature_points; ++i) {
            // Facets that are seen at grazing angles lie at the far end: there the points are dense.
            const float t = (static_cast<float>(i) + 0.5f) / quadrature_points;
            const float turn = static_cast<float>(i) * 233 / quadrature_points;  // neighbours in Fibonacci's sequence
            const Vec3 normal = sample_visible_normal(view, alpha, turn - std::floor(turn), 1 - square(1 - t));
            const float c = std::min(dot(view, normal), 1.0f);
            facets[i] = {2 * (1 - t) / quadrature_points, c, normal.z, unshadowed(2 * c * normal.z - cosine)};
        }
    }

    /// Share of the light scattered towards a cosine that is not shadowed on its way out.
    float unshadowed(float leaving) const {
        return leaving > 0 ? ggx_shadowing(cosine, leaving, alpha) / ggx_masking(cosine, alpha) : 0.0f;
    }

    template <typename Value>
    float mean(Value value) const {
        float sum = 0;
        for (const SampledFacet &facet : facets) sum += facet.weight * value(facet);
        return sum;
    }

    float reflected() const {
        return mean([](const SampledFacet &facet) { return facet.reflection; });
    }

    float scattered_by_glass(float eta) const {
        return mean([&](const SampledFacet &facet) {
            const DielectricFresnel fresnel = fresnel_dielectric(facet.cosine, eta);
            const float refracted = facet.height * (facet.cosine / eta - fresnel.cosine) - cosine / eta;
            return fresnel.reflectance * facet.reflection + (1 - fresnel.reflectance) * unshadowed(-refracted);
        });
    }

    /// The mean of a function of the cosine; facets that reflect into the surface count as 0.
    template <typename Rise>
    float mean_rise(Rise rise) const {
        return mean([&](const SampledFacet &facet) { return facet.reflection > 0 ? rise(facet.cosine) : 0.0f; });
    }
};

/// Calls `fill(rough, direction, facets)` for all quadrature_points of a table.
template <typename Fill>
void for_each_point(size_t size, Fill fill) {
    for (size_t rough = 0; rough < size; ++rough)
        for (size_t direction = 0; direction < size; ++direction)
            fill(rough, direction, Facets(rough, direction, size));
}

EnergyTable make_reflection() {
    EnergyTable table(fine);
    for_each_point(fine, [&](size_t rough, size_t direction, const Facets &facets) {
        table.at(rough, direction) = facets.reflected();
    });
    table.average();
    return table;
}

EnergyTable make_schlick() {
    EnergyTable table(coarse);
    for_each_point(coarse, [&](size_t rough, size_t direction, const Facets &facets) {
        table.at(rough, direction) = facets.mean_rise(schlick_rise);
    });
    return table;
}

/// Tables for indices of refraction: sqrt((eta - 1) / (eta + 1)) goes from 0 to 1 in equal steps.
struct DielectricTables {
    std::vector<EnergyTable> into, out_of, rise;

    DielectricTables() : into(coarse, EnergyTable(coarse)), out_of(into), rise(into) {
        for_each_point(coarse, [&](size_t rough, size_t direction, const Facets &facets) {
            for (size_t slice = 0; slice < coarse; ++slice) {
                const float eta = ior_of_f0(square(square(std::min(grid_point(slice, coarse), 0.99f))));
                // At equal indices nothing is bent, and the facets shadow nothing.
                into[slice].at(rough, direction) = slice == 0 ? 1 : facets.scattered_by_glass(eta);
                out_of[slice].at(rough, direction) = slice == 0 ? 1 : facets.scattered_by_glass(1 / eta);
                rise[slice].at(rough, direction) = facets.mean_rise(
                    [&](float cosine) { return fresnel_rise(fresnel_dielectric(cosine, eta).reflectance, eta); });
            }
        });
        for (std::vector<EnergyTable> *tables : {&into, &out_of})
            for (EnergyTable &table : *tables) table.average();
    }
};

const DielectricTables &dielectric_tables() {
    static const DielectricTables tables;
    return tables;
}

Between between_indices(float eta) { return {std::sqrt(std::abs((eta - 1) / (eta + 1))), coarse}; }

}  // namespace

GgxAlbedo ggx_reflection_albedo(float roughness, float cosine) {
    static const EnergyTable table = make_reflection();
    return {table.look_up(roughness, cosine), table.look_up_average(roughness)};
}

GgxAlbedo ggx_glass_albedo(float roughness, float cosine, float eta) {
    const std::vector<EnergyTable> &tables = eta < 1 ? dielectric_tables().out_of : dielectric_tables().into;
    const Between z = between_indices(eta);
    const EnergyTable &below = tables[z.below], &above = tables[z.above];
    return {z.mix(below.look_up(roughness, cosine), above.look_up(roughness, cosine)),
            z.mix(below.look_up_average(roughness), above.look_up_average(roughness))};
}

float ggx_fresnel_rise(float roughness, float cosine, float eta) {
    const std::vector<EnergyTable> &tables = dielectric_tables().rise;
    const Between z = between_indices(eta);
    return z.mix(tables[z.below].look_up(roughness, cosine), tables[z.above].look_up(roughness, cosine));
}

float ggx_schlick_rise(float roughness, float cosine) {
    static const EnergyTable table = make_schlick();
    return table.look_up(roughness, cosine);
}

}  // namespace photon_maps
