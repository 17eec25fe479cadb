// SPDX-License-Identifier: GPL-3.0-or-later
// The radiance estimate against brute force, and against the truth where surfaces end.
#include <random>
#include <string>

#include "check.h"
#include "estimate.h"
#include "published_kernels.h"

using namespace photon_maps;

namespace {

constexpr std::array filters{PM_FILTER_NONE, PM_FILTER_CONE, PM_FILTER_GAUSSIAN, PM_FILTER_EPANECHNIKOV};
constexpr Vec3 up{0, 0, 1};

Vec3 random_direction(std::mt19937 &random) {
    std::normal_distribution<float> normal;
    return normalize({normal(random), normal(random), normal(random)});
}

/// Returns whether the segments p-q and a-b cross, in the plane z = 0.
bool cross_each_other(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
    const auto side = [](Vec3 s, Vec3 e, Vec3 x) {
        return (double{e.x} - s.x) * (double{x.y} - s.y) - (double{e.y} - s.y) * (double{x.x} - s.x) > 0;
    };
    return side(p, q, a) != side(p, q, b) && side(a, b, p) != side(a, b, q);
}

/// The estimate as its definition says, photon by photon.
Estimate brute_force(const std::vector<Photon> &photons, const std::vector<FeatureEdge> &edges, const Query &query,
                     const Kernel &kernel, double share) {
    std::array<double, 3> flux{};
    uint32_t count = 0;
    for (const Photon &photon : photons) {
        const Vec3 d = photon.position - query.position;
        const double t = double{length_squared(d)} / (double{kernel.radius} * kernel.radius);
        if (t >= 1 || std::abs(dot(d, query.normal)) >= 0.15f * kernel.radius) continue;
        if (dot(unpack_normal(photon.normal), query.normal) <= 0.7f) continue;
        const auto hides = [&](const FeatureEdge &e) {
            return std::abs(dot(e.normal, query.normal)) > 0.7f &&
                   cross_each_other(query.position, photon.position, e.a, e.b);
        };
        if (std::ranges::any_of(edges, hides)) continue;
        double weight = test::published_weight(kernel, t);
        if (!(query.shading_normal == query.normal)) {
            const Vec3 to_light = -unpack_direction(photon.direction);
            const double shading = std::max(dot(query.shading_normal, to_light), 0.0f);
            weight *= std::min(shading / std::max(double{dot(query.normal, to_light)}, 1e-6), 8.0);
        }
        ++count;
        for (size_t c = 0; c < 3; ++c) flux[c] += weight * double{photon.flux[static_cast<int>(c)]};
    }
    const double area = double{kernel.norm()} * share;
    const auto channel = [&](size_t c) { return static_cast<float>(flux[c] / area); };
    return {{channel(0), channel(1), channel(2)}, count};
}

std::vector<FeatureEdge> polygon(const std::vector<Vec3> &corners, Vec3 normal) {
    std::vector<FeatureEdge> edges;
    for (size_t i = 0; i < corners.size(); ++i)
        edges.push_back({corners[i], corners[(i + 1) % corners.size()], normal});
    return edges;
}

std::vector<FeatureEdge> rectangle(float x0, float y0, float x1, float y1, Vec3 normal) {
    return polygon({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}}, normal);
}

void check_against_brute_force(test::Checks &checks) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<Photon> photons;
    for (int i = 0; i < 30000; ++i) {
        // On two levels, of any orientation, from anywhere.
        const Vec3 position{uniform(random), uniform(random), 0.05f * uniform(random) + (i % 4 == 0 ? 0.3f : 0.0f)};
        const Vec3 normal = i % 3 == 0 ? random_direction(random) : up;
        photons.push_back({position,
                           {uniform(random), uniform(random), uniform(random)},
                           pack_normal(normal, 255),
                           pack_direction(random_direction(random))});
    }
    const PhotonMap map(photons, 2, nullptr);
    const EdgeIndex no_edges;
    // Edges in the plane of the queries.
    std::vector<FeatureEdge> edges = rectangle(0.2f, 0.25f, 0.7f, 0.8f, up);
    edges.push_back({{0.1f, 0.9f, 0}, {0.9f, 0.1f, 0}, -up});
    edges.push_back({{0.5f, 0, 0}, {0.5f, 1, 0}, {1, 0, 0}});  // of a wall: no obstacle
    const EdgeIndex index(edges, 0.25f);

    for (int round = 0; round < 400; ++round) {
        const Vec3 position{uniform(random), uniform(random), 0};
        const Vec3 shading_normal = round % 2 == 0 ? up : normalize(up + 0.7f * random_direction(random));
        const Query query{position, up, shading_normal};
        const Kernel kernel{filters[static_cast<size_t>(round) / 2 % 4], 0.02f + 0.23f * uniform(random), 1.1f};
        const bool is_cut = round % 3 == 0;
        const double share = is_cut ? double{KernelRegion(index, position, up, kernel).share()} : 1;
        const Estimate expected =
            brute_force(photons, is_cut ? edges : std::vector<FeatureEdge>{}, query, kernel, share);
        const Estimate found = estimate_photons(map, is_cut ? index : no_edges, query, kernel);
        checks.that(expected.photons == 0 || found.photons > 0, "photons are found");
        checks.near(found.photons, expected.photons, 0, "the number of photons");
        for (int c = 0; c < 3; ++c) {
            const double tolerance = 2e-5 * double{expected.value[c]};
            checks.near(double{found.value[c]}, double{expected.value[c]}, tolerance, "irradiance");
        }
    }
    const Query query{{0.5f, 0.5f, 0}, up, up};
    checks.that(estimate_photons(PhotonMap(), index, query, {PM_FILTER_NONE, 0.1f, 1}).photons == 0, "an empty map");
}

/// Photons on a square lattice over a region of the plane z = 0: irradiance 1 wherever the surface is.
template <typename Inside>
std::vector<Photon> lattice(float spacing, Vec3 normal, const Inside &inside) {
    std::vector<Photon> photons;
    const int count = static_cast<int>(2 / spacing);
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const Vec3 p{-1 + spacing * (static_cast<float>(i) + 0.5f), -1 + spacing * (static_cast<float>(j) + 0.5f),
                         0};
            const float flux = spacing * spacing;
            if (inside(p)) photons.push_back({p, {flux, flux, flux}, pack_normal(normal, 0), pack_direction(-normal)});
        }
    }
    return photons;
}

/// The estimate of a uniform irradiance is uniform wherever it is asked for.
template <typename Inside>
void check_flat(test::Checks &checks, const std::string &name, const std::vector<FeatureEdge> &edges, Vec3 normal,
                const std::vector<Vec3> &points, const Inside &inside) {
    const PhotonMap map(lattice(1.0f / 512, normal, inside), 2, nullptr);
    const EdgeIndex index(edges, 0.2f);
    for (const pm_filter filter : filters) {
        for (const Vec3 p : points) {
            const Kernel kernel{filter, 0.2f, 1};
            const Estimate found = estimate_photons(map, index, {p, normal, normal}, kernel);
            checks.near(double{found.value.y}, 1, 0.01,
                        name + " at " + std::to_string(p.x) + ", " + std::to_string(p.y) + " by filter " +
                            std::to_string(filter));
        }
    }
}

void check_where_surfaces_end(test::Checks &checks) {
    const auto in_square = [](Vec3 p) { return std::abs(p.x) < 0.5f && std::abs(p.y) < 0.5f; };
    const auto square = rectangle(-0.5f, -0.5f, 0.5f, 0.5f, up);
    const std::vector<Vec3> into_corner{{0, 0, 0},         {0.4f, 0.1f, 0},   {0.45f, 0.45f, 0}, {0.49f, 0.4f, 0},
                                        {0.49f, 0.49f, 0}, {0.3f, -0.48f, 0}, {-0.4f, -0.4f, 0}, {-0.45f, 0.2f, 0}};
    check_flat(checks, "corner", square, up, into_corner, in_square);
    check_flat(checks, "corner from behind", square, -up, into_corner, in_square);

    // Around a reflex corner, exactly in it, too, and in a sharp one.
    const auto in_angle = [&](Vec3 p) { return in_square(p) && !(p.x > 0 && p.y < 0); };
    const auto angle =
        polygon({{0, 0, 0}, {0.5f, 0, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}, {-0.5f, -0.5f, 0}, {0, -0.5f, 0}}, up);
    check_flat(checks, "reflex corner", angle, up,
               {{0, 0, 0}, {-0.01f, 0.01f, 0}, {-0.02f, -0.1f, 0}, {0.1f, 0.05f, 0}, {-0.1f, -0.45f, 0}}, in_angle);
    const auto in_sharp = [](Vec3 p) { return p.x > -0.5f && p.x < 0.5f && p.y > 0 && p.y < 0.5f * (p.x + 0.5f); };
    const auto sharp = polygon({{-0.5f, 0, 0}, {0.5f, 0, 0}, {0.5f, 0.5f, 0}}, up);
    check_flat(checks, "sharp corner", sharp, up, {{-0.3f, 0.05f, 0}, {-0.35f, 0.01f, 0}, {0.48f, 0.47f, 0}}, in_sharp);

    // A thin wall stands on the floor: its underside is an obstacle, and what lies beyond is another room.
    auto walled = square;
    const auto wall = rectangle(0.1f, -0.5f, 0.12f, 0.5f, -up);
    walled.insert(walled.end(), wall.begin(), wall.end());
    const auto in_room = [&](Vec3 p) { return in_square(p) && p.x < 0.1f; };
    check_flat(checks, "thin wall", walled, up, {{0, 0, 0}, {0.05f, 0.3f, 0}, {0.09f, 0, 0}, {0.08f, 0.48f, 0}},
               in_room);

    // A box on the floor, and one that overhangs the floor's side.
    const auto outside_box = [&](Vec3 p) {
        return in_square(p) && !(p.x > -0.1f && p.x < 0.2f && p.y > -0.1f && p.y < 0.2f);
    };
    auto with_box = square;
    const auto box = rectangle(-0.1f, -0.1f, 0.2f, 0.2f, -up);
    with_box.insert(with_box.end(), box.begin(), box.end());
    check_flat(checks, "box", with_box, up, {{-0.15f, 0, 0}, {-0.12f, -0.12f, 0}, {0.25f, 0.25f, 0}, {0.21f, 0.1f, 0}},
               outside_box);
    const auto beside_overhang = [&](Vec3 p) { return in_square(p) && !(p.x > 0.3f && p.y > -0.1f && p.y < 0.2f); };
    auto overhang = square;
    const auto plank = rectangle(0.3f, -0.1f, 0.9f, 0.2f, -up);
    overhang.insert(overhang.end(), plank.begin(), plank.end());
    check_flat(checks, "overhang", overhang, up,
               {{0.25f, 0, 0}, {0.45f, 0.25f, 0}, {0.29f, 0.21f, 0}, {0.48f, -0.2f, 0}}, beside_overhang);

    // Without edges the corner is dark: the check above can fail.
    const PhotonMap map(lattice(1.0f / 512, up, in_square), 2, nullptr);
    const Estimate dark = estimate_photons(map, EdgeIndex(), {{0.49f, 0.49f, 0}, up, up}, {PM_FILTER_NONE, 0.2f, 1});
    checks.that(dark.value.x < 0.4f, "without edges a corner is dark");
}

void check_shading_normals(test::Checks &checks) {
    // Light straight from above: what is shaded as tilted by an angle receives its cosine.
    const PhotonMap map(lattice(1.0f / 256, up, [](Vec3) { return true; }), 2, nullptr);
    for (const float angle : {0.1f, 0.5f, 1.0f}) {
        const Query query{{0, 0, 0}, up, {std::sin(angle), 0, std::cos(angle)}};
        const Estimate found = estimate_photons(map, EdgeIndex(), query, {PM_FILTER_EPANECHNIKOV, 0.2f, 1});
        checks.near(double{found.value.x}, std::cos(double{angle}), 0.01, "a tilted shading normal");
    }
}

void check_radius_holding(test::Checks &checks) {
    std::mt19937 random(23);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Photon> photons;
    for (int i = 0; i < 20000; ++i) {
        photons.push_back({{uniform(random), uniform(random), i % 2 == 0 ? 0.0f : 0.05f},
                           {1, 1, 1},
                           pack_normal(i % 5 == 0 ? -up : up, 0),
                           pack_direction(-up)});
    }
    const PhotonMap map(photons, 1, nullptr);
    for (const size_t k : std::initializer_list<size_t>{1, 10, 100, 3000}) {
        const Query query{{0.3f * uniform(random), 0.3f * uniform(random), 0}, up, up};
        const float radius = radius_holding(map, query, k, 1);
        const auto count = [&](float r) {
            return estimate_photons(map, EdgeIndex(), query, {PM_FILTER_NONE, r, 1}).photons;
        };
        checks.that(count(radius * 1.0001f) >= k, "the radius holds k photons");
        checks.that(count(radius * 0.9999f) < k, "a smaller one does not");
    }
    checks.near(double{radius_holding(map, {{0, 0, 0}, up, up}, 30000, 0.5f)}, 0.5, 0, "too few photons");
    checks.near(double{radius_holding(PhotonMap(), {{0, 0, 0}, up, up}, 1, 0.5f)}, 0.5, 0, "no photons");
}

/// The nearest photons by brute force: so many count and not one more, whatever the rounding; and their estimate.
void check_kernel_of_nearest(test::Checks &checks) {
    std::mt19937 random(29);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<Photon> photons;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 normal = i % 5 == 0 ? -up : up;
        photons.push_back(
            {{uniform(random), uniform(random), 0}, {1, 1, 1}, pack_normal(normal, 0), pack_direction(-up)});
    }
    const PhotonMap map(photons, 1, nullptr);
    for (const size_t count : std::initializer_list<size_t>{1, 2, 10, 100, 1000}) {
        double mean = 0;
        int fewer = 0;
        constexpr int rounds = 2000;
        for (int round = 0; round < rounds; ++round) {
            const Query query{{0.6f * uniform(random), 0.6f * uniform(random), 0}, up, up};
            const Kernel largest{PM_FILTER_NONE, 1.5f, 1};
            const Kernel kernel = kernel_of_nearest(map, query, count, largest);
            const Estimate found = estimate_photons(map, EdgeIndex(), query, kernel);
            mean += double{found.value.x} / rounds;
            checks.that(found.photons <= count, "no more than the nearest photons");
            fewer += found.photons < count;
            if (round >= 20) continue;
            std::vector<float> distances;
            for (const Photon &photon : photons)
                if (unpack_normal(photon.normal).z > 0) distances.push_back(length(photon.position - query.position));
            std::ranges::sort(distances);
            checks.near(double{kernel.radius}, double{distances[count]}, 2e-6 * double{distances[count]},
                        "as large as the next is far");
        }
        checks.that(fewer < 10, "no fewer, but where the last and the next are equally far");
        // Four fifths of 20000 photons on four square metres. The nearest one alone has no bounded variance.
        if (count >= 10) checks.near(mean, 4000, 80, "the mean of " + std::to_string(count) + " nearest");
    }

    // Where they are too few, and where they lie on each other.
    const Kernel largest{PM_FILTER_CONE, 0.5f, 1.1f};
    const Query query{{0, 0, 0}, up, up};
    const Kernel all = kernel_of_nearest(map, query, 30000, largest);
    checks.that(all.radius == largest.radius && all.filter == largest.filter && all.cone_k == largest.cone_k,
                "too few photons: the largest kernel");
    const std::vector<Photon> heap(100, {{0, 0, 0}, {1, 1, 1}, pack_normal(up, 0), pack_direction(-up)});
    const Kernel least = kernel_of_nearest(PhotonMap(heap, 1, nullptr), query, 10, largest);
    checks.that(least.radius > 0 && least.radius < 1e-5f, "photons on each other: a small kernel, but one");
}

}  // namespace

int main() {
    test::Checks checks;
    check_kernel_of_nearest(checks);
    check_against_brute_force(checks);
    check_where_surfaces_end(checks);
    check_shading_normals(checks);
    check_radius_holding(checks);
    return checks.report();
}
