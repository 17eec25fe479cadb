// SPDX-License-Identifier: GPL-3.0-or-later
// The remaining share of kernels against numeric integration, and the index of edges against brute force.
#include <random>
#include <string>

#include "check.h"
#include "kernel_area.h"

using namespace photon_maps;

namespace {

constexpr std::array filters{PM_FILTER_NONE, PM_FILTER_CONE, PM_FILTER_GAUSSIAN, PM_FILTER_EPANECHNIKOV};

/// Returns how far one sees from the origin in a direction, up to 1.
double visible_distance(std::span<const Barrier> barriers, double dx, double dy) {
    double nearest = 1;
    for (const Barrier &barrier : barriers) {
        const double ex = double{barrier.bx} - barrier.ax, ey = double{barrier.by} - barrier.ay;
        const double determinant = dx * ey - dy * ex;
        if (determinant == 0) continue;
        const double s = (barrier.ax * ey - barrier.ay * ex) / determinant;  // along the ray
        const double t = (barrier.ax * dy - barrier.ay * dx) / determinant;  // along the barrier
        if (s > 0 && t >= 0 && t <= 1) nearest = std::min(nearest, s);
    }
    return nearest;
}

/// Returns the remaining share by summing over directions; radially the kernel is integrated as test_filter checks.
double numeric_share(std::span<const Barrier> barriers, const Kernel &kernel) {
    constexpr int directions = 40000;
    double sum = 0;
    for (int i = 0; i < directions; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / directions;
        sum += double{kernel.wedge(static_cast<float>(visible_distance(barriers, std::cos(angle), std::sin(angle))))};
    }
    return sum / directions / double{kernel.wedge(1)};
}

void check_shares(test::Checks &checks, const std::string &name, std::span<const Barrier> barriers) {
    for (const pm_filter filter : filters) {
        const Kernel kernel{filter, 1, 1.25f};
        const KernelRegion region(barriers, kernel);
        checks.near(double{region.share()}, numeric_share(barriers, kernel), 1e-4,
                    name + ": share of filter " + std::to_string(filter));
    }
    // What is hidden is what a barrier stands before, but for points too near to a border to tell.
    const KernelRegion region(barriers, {PM_FILTER_NONE, 1, 1});
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < 300; ++i) {
        const float u = uniform(random), v = uniform(random), length = std::sqrt(u * u + v * v);
        if (length > 0.999f || length < 1e-3f) continue;
        const auto visible = [&](double turn) {
            return visible_distance(barriers, double{u / length} - turn * double{v / length},
                                    double{v / length} + turn * double{u / length});
        };
        const bool hidden = visible(0) < double{length};
        if ((visible(1e-4) < double{length}) != hidden || (visible(-1e-4) < double{length}) != hidden) continue;
        if (std::abs(visible(0) - double{length}) < 1e-4) continue;
        const bool found = std::ranges::any_of(region.barriers(), [&](const Barrier &b) { return b.hides(u, v) != 0; });
        checks.that(found == hidden, name + ": hidden points");
    }
}

void check_random_shares(test::Checks &checks) {
    check_shares(checks, "no barrier", {});
    check_shares(checks, "outside", std::vector<Barrier>{{2, -1, 2, 1}, {-1, 1.5f, 1, 1.5f}});
    check_shares(checks, "through the disc", std::vector<Barrier>{{-5, -0.3f, 5, -0.3f}});
    check_shares(checks, "directed the other way", std::vector<Barrier>{{5, -0.3f, -5, -0.3f}});
    check_shares(checks, "short", std::vector<Barrier>{{0.2f, 0.1f, 0.25f, 0.3f}});
    check_shares(checks, "a point", std::vector<Barrier>{{0.5f, 0.1f, 0.5f, 0.10000001f}, {0.2f, 0.2f, 0.2f, 0.2f}});
    check_shares(checks, "nearly touched", std::vector<Barrier>{{-2, 1e-4f, 2, 1e-4f}});
    check_shares(checks, "corner", std::vector<Barrier>{{-0.2f, -0.1f, 3, -0.1f}, {-0.2f, 3, -0.2f, -0.1f}});
    check_shares(checks, "reflex corner", std::vector<Barrier>{{-0.2f, -0.1f, 3, -0.1f}, {-0.2f, -3, -0.2f, -0.1f}});
    check_shares(checks, "duplicates", std::vector<Barrier>{{0.3f, -1, 0.3f, 1}, {0.3f, 1, 0.3f, -1}});
    check_shares(checks, "one behind the other", std::vector<Barrier>{{0.3f, -1, 0.3f, 1}, {0.5f, -1, 0.5f, 1}});
    check_shares(checks, "nearer part", std::vector<Barrier>{{0.5f, -1, 0.5f, 1}, {0.2f, -0.1f, 0.2f, 0.1f}});
    check_shares(checks, "crossing", std::vector<Barrier>{{0.1f, -1, 0.6f, 1}, {0.6f, -1, 0.1f, 1}});
    check_shares(checks, "box around",
                 std::vector<Barrier>{{-0.3f, -0.4f, 0.5f, -0.4f},
                                      {0.5f, -0.4f, 0.5f, 0.6f},
                                      {0.5f, 0.6f, -0.3f, 0.6f},
                                      {-0.3f, 0.6f, -0.3f, -0.4f}});
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(-1.2f, 1.2f);
    for (size_t round = 0; round < 120; ++round) {
        std::vector<Barrier> barriers;
        for (size_t i = 0; i < 1 + round % 12; ++i) {
            Barrier barrier{uniform(random), uniform(random), uniform(random), uniform(random)};
            // Every other set is a chain, whose barriers share their ends.
            if (round % 2 == 1 && i > 0) barrier.ax = barriers[i - 1].bx, barrier.ay = barriers[i - 1].by;
            barriers.push_back(barrier);
        }
        check_shares(checks, "random set " + std::to_string(round), barriers);
    }
}

/// The half-edges of a polygon in the plane z = height, counter-clockwise as seen against its normal.
std::vector<FeatureEdge> polygon(std::vector<Vec3> corners, Vec3 normal) {
    std::vector<FeatureEdge> edges;
    for (size_t i = 0; i < corners.size(); ++i)
        edges.push_back({corners[i], corners[(i + 1) % corners.size()], normal});
    return edges;
}

void check_on_edges(test::Checks &checks) {
    const Vec3 up{0, 0, 1};
    const auto floor = polygon({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, up);
    const EdgeIndex index(floor, 1);
    const EdgeIndex reflex(polygon({{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {-5, 5, 0}, {-5, -5, 0}, {0, -5, 0}}, up), 1);
    for (const pm_filter filter : filters) {
        const Kernel kernel{filter, 1, 1};
        const auto share = [&](const EdgeIndex &edges, Vec3 p) {
            return double{KernelRegion(edges, p, up, kernel).share()};
        };
        checks.near(share(index, {5, 5, 0}), 1, 0, "far from the edges");
        checks.near(share(index, {5, 0, 0}), 0.5, 1e-5, "on an edge");
        checks.near(share(index, {0, 0, 0}), 0.25, 1e-5, "in a corner");
        checks.near(share(index, {10, 10, 0}), 0.25, 1e-5, "in the corner far from the origin");
        checks.near(share(index, {5, 1e-7f, 0}), 0.5, 1e-5, "just inside");
        checks.near(share(index, {5, -1e-7f, 0}), 0.5, 1e-5, "just outside, by rounding");
        checks.near(share(index, {1e-5f, 1e-5f, 0}), 0.25, 1e-4, "almost in a corner");
        // Exactly there both edges reach a little further than they should; test_estimate shows that this is no bias.
        checks.that(share(reflex, {0, 0, 0}) > 0.25 && share(reflex, {0, 0, 0}) < 0.7501, "in a reflex corner");
        checks.near(share(reflex, {-1e-4f, 1e-4f, 0}), 0.75, 1e-3, "beside a reflex corner");
        checks.near(share(index, {5, 0.5f, 0.2f}), 1, 0, "above the plane by more than the tolerance");
        checks.that(share(index, {5, 0.5f, 0.1f}) < 1, "above it by less");
    }

    // From behind, and from above a box that stands on the floor, of which only the underside is an obstacle.
    const Kernel kernel{PM_FILTER_NONE, 1, 1};
    checks.near(double{KernelRegion(index, {5, 0, 0.0f}, -up, kernel).share()}, 0.5, 1e-5, "on an edge from behind");
    checks.near(double{KernelRegion(index, {5, 0.2f, 0}, {0, 1, 0}, kernel).share()}, 1, 0, "another orientation");
    const EdgeIndex box(polygon({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, -up), 1);
    checks.near(double{KernelRegion(box, {1, 0.5f, 0}, up, kernel).share()}, 0.5, 0.15, "at a box's foot");
    checks.that(KernelRegion(box, {1.2f, 0.5f, 0}, up, kernel).share() < 0.99f, "beside a box");

    // Two faces that meet but are not joined: on their seam the surface goes on.
    auto halves = polygon({{0, 0, 0}, {5, 0, 0}, {5, 10, 0}, {0, 10, 0}}, up);
    const auto other = polygon({{5, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5, 10, 0}}, up);
    halves.insert(halves.end(), other.begin(), other.end());
    checks.near(double{KernelRegion(EdgeIndex(halves, 1), {5, 5, 0}, up, kernel).share()}, 1, 0, "on a seam");

    // Edges far longer than the radius lose no accuracy.
    const EdgeIndex vast(polygon({{-1e6f, 0, 0}, {1e6f, 0, 0}, {1e6f, 1e6f, 0}, {-1e6f, 1e6f, 0}}, up), 1e-3f);
    const Kernel small{PM_FILTER_NONE, 1e-3f, 1};
    const double half_way = double{KernelRegion(vast, {0.25f, 5e-4f, 0}, up, small).share()};
    const std::vector<Barrier> expected{{-1, -0.5f, 1, -0.5f}};
    checks.near(half_way, numeric_share(expected, {PM_FILTER_NONE, 1, 1}), 2e-4, "a long edge");

    bool refused = false;
    try {
        const KernelRegion region(index, {5, 5, 0}, up, {PM_FILTER_NONE, 1.5f, 1});
    } catch (const std::invalid_argument &) {
        refused = true;
    }
    checks.that(refused, "a kernel larger than the index is refused");
}

double distance_to_edge(const FeatureEdge &edge, Vec3 p) {
    const std::array<double, 3> ab{double{edge.b.x} - edge.a.x, double{edge.b.y} - edge.a.y,
                                   double{edge.b.z} - edge.a.z};
    const std::array<double, 3> ap{double{p.x} - edge.a.x, double{p.y} - edge.a.y, double{p.z} - edge.a.z};
    double along = 0, squared = 0, distance_squared = 0;
    for (size_t i = 0; i < 3; ++i) along += ab[i] * ap[i], squared += ab[i] * ab[i];
    const double s = std::clamp(along / squared, 0.0, 1.0);
    for (size_t i = 0; i < 3; ++i) distance_squared += (ap[i] - s * ab[i]) * (ap[i] - s * ab[i]);
    return std::sqrt(distance_squared);
}

void check_index(test::Checks &checks) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1, 1);
    const auto point = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    for (const float scale : {1e-6f, 1.0f, 1e7f}) {
        std::vector<FeatureEdge> edges;
        for (int i = 0; i < 500; ++i) {
            const Vec3 a = point() * scale;
            edges.push_back({a, i % 2 == 0 ? point() * scale : a + point() * (0.01f * scale), {0, 0, 1}});
        }
        const float radius = 0.05f * scale;
        const EdgeIndex index(edges, radius);
        size_t candidates = 0, wanted = 0;
        for (int query = 0; query < 2000; ++query) {
            const Vec3 p = point() * (1.1f * scale);
            const auto found = index.lookup(p);
            candidates += found.size();
            bool ascending = true, complete = true;
            for (size_t i = 1; i < found.size(); ++i) ascending = ascending && found[i - 1] < found[i];
            for (uint32_t i = 0; i < edges.size(); ++i) {
                if (distance_to_edge(edges[i], p) > double{radius}) continue;
                ++wanted;
                complete = complete && std::ranges::binary_search(found, i);
            }
            checks.that(ascending, "candidates ascend");
            checks.that(complete, "candidates include every near edge");
        }
        checks.that(wanted > 100, "the test meets edges");
        checks.that(candidates < 30 * wanted, "candidates are few");
    }
    checks.that(EdgeIndex().lookup({1, 2, 3}).empty(), "an empty index has no candidates");
    checks.that(EdgeIndex({}, 1).lookup({1, 2, 3}).empty(), "neither has one of no edges");

    // A thousand edges of a thousand kilometres at a radius of a millimetre: memory stays bounded.
    std::vector<FeatureEdge> vast;
    for (int i = 0; i < 1000; ++i) vast.push_back({point() * 1e6f, point() * 1e6f, {0, 0, 1}});
    checks.that(EdgeIndex(vast, 1e-3f).memory_bytes() < 512u << 20, "memory is bounded");
}

/// A sheet across a floor: it cuts the disc in half for who stands at its foot, whichever side; not what ends above the
/// floor, nor the sheet's own other edges.
void check_sheets(test::Checks &checks) {
    const std::vector<Vec3> vertices = {{-9, 0, 0}, {9, 0, 0}, {9, 0, 4}, {-9, 0, 4}};
    const std::vector<std::array<uint32_t, 3>> triangles = {{0, 1, 2}, {0, 2, 3}};
    const EdgeIndex edges(find_feature_edges(vertices, triangles), 1.0f);
    for (const pm_filter filter : filters) {
        const Kernel kernel{filter, 1, 1.25f};
        for (const float side : {-1.0f, 1.0f}) {
            const KernelRegion at_foot(edges, {0, 1e-3f * side, 0}, {0, 0, 1}, kernel);
            checks.near(double{at_foot.share()}, 0.5, 2e-3, "half a disc at the foot of a sheet");
            const KernelRegion beyond(edges, {0, 1.5f * side, 0}, {0, 0, 1}, kernel);
            checks.near(double{beyond.share()}, 1, 0, "the whole disc away from it");
        }
        const KernelRegion below(edges, {0, 0.1f, -0.1f}, {0, 0, 1}, kernel);
        checks.near(double{below.share()}, 1, 0, "the sheet ends above the floor");
        const KernelRegion ceiling(edges, {0, 0.1f, 0}, {0, 0, -1}, kernel);
        checks.near(double{ceiling.share()}, 1, 0, "the sheet stands on the other side");
    }
    const std::vector<Vec3> solid = {{-9, 0, 0}, {9, 0, 0}, {9, 0, 4}, {-9, 0, 4}, {9, 1, 0}, {-9, 1, 0}};
    const std::vector<std::array<uint32_t, 3>> folded = {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {0, 5, 4}};
    for (const FeatureEdge &edge : find_feature_edges(solid, folded)) {
        const bool is_fold = edge.a.y == 0 && edge.b.y == 0 && edge.a.z == 0 && edge.b.z == 0;
        checks.that(edge.is_open == !is_fold, "an edge that two faces share is not open");
    }
}

}  // namespace

int main() {
    test::Checks checks;
    check_random_shares(checks);
    check_on_edges(checks);
    check_index(checks);
    check_sheets(checks);
    return checks.report();
}
