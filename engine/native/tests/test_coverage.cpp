// SPDX-License-Identifier: GPL-3.0-or-later
// The covered share of discs on a plane, a sphere and a bent sheet against what geometry says.
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include "check.h"
#include "coverage.h"

using namespace photon_maps;

namespace {

constexpr Kernel epanechnikov{PM_FILTER_EPANECHNIKOV, 0.1f, 1};

Kernel with_radius(float radius) {
    Kernel kernel = epanechnikov;
    kernel.radius = radius;
    return kernel;
}

/// Returns a sheet of `columns` x `rows` quads whose vertices a function of the unit square places.
template <typename Place>
Mesh sheet(uint32_t columns, uint32_t rows, Place place) {
    Mesh mesh;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i)
            mesh.vertices.push_back(place(static_cast<float>(i) / static_cast<float>(columns),
                                          static_cast<float>(j) / static_cast<float>(rows)));
    mesh.vertices.emplace_back();
    const uint32_t stride = columns + 1;
    for (uint32_t j = 0; j < rows; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = j * stride + i;
            mesh.triangles.push_back({a, a + 1, a + stride + 1});
            mesh.triangles.push_back({a, a + stride + 1, a + stride});
        }
    }
    return mesh;
}

Mesh plane(uint32_t cells) {
    return sheet(cells, cells, [](float u, float v) { return Vec3{u, v, 0}; });
}

Mesh sphere(float radius, uint32_t rings) {
    return sheet(2 * rings, rings, [=](float u, float v) {
        const float theta = pi * v, phi = u < 1 ? 2 * pi * u : 0;  // the seam is closed
        return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} * radius;
    });
}

/// A mesh on its own and its edges, ready to be asked.
struct World {
    Scene scene;
    EdgeIndex edges;

    World(Mesh mesh, float largest_radius)
        : scene(std::make_shared<const Embree>(std::getenv("PHOTON_MAPS_EMBREE") ? std::getenv("PHOTON_MAPS_EMBREE")
                                                                                 : "")) {
        scene.meshes.push_back(std::move(mesh));
        scene.instances.emplace_back();
        scene.slot_materials = {0};
        scene.materials.resize(1);
        scene.materials[0].traits.lobes = diffuse_reflection;
        scene.freeze();
        scene.build(1, nullptr);
        edges = EdgeIndex({scene.feature_edges().begin(), scene.feature_edges().end()}, largest_radius);
    }

    SurfacePoint met(Vec3 origin, Vec3 target) const {
        SurfacePoint hit;
        if (!scene.intersect({origin, target - origin}, hit)) throw std::runtime_error("the ray met nothing");
        return hit;
    }
};

void check_fine_plane(test::Checks &checks) {
    const World world(plane(64), 0.1f);
    const Coverage coverage(world.scene, world.edges, with_radius(0.1f));
    for (const float side : {-1.0f, 1.0f}) {
        for (const Vec3 target :
             {Vec3{0.5f, 0.5f, 0}, Vec3{0.317f, 0.743f, 0}, Vec3{0.004f, 0.5f, 0}, Vec3{0.99f, 0.995f, 0}}) {
            for (const float radius : {0.1f, 0.08f, 0.03f}) {
                const Coverage::Disc disc = coverage.disc(world.met(target + Vec3{0, 0, side}, target), radius);
                checks.that(disc.radius == radius, "a plane is gathered over the radius asked for");
                checks.near(double{disc.share}, 1, 1e-4, "a plane is covered up to its edges");
            }
        }
    }
}

/// Returns the share on a sphere by integration over the disc: of its points only those within the tolerances count.
double sphere_share(double sphere_radius, double radius) {
    constexpr int steps = 20000;
    double covered = 0, whole = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps;  // squared distance from the disc's centre, uniform by area
        whole += 1 - t;
        const double sine = std::sqrt(t) * radius / sphere_radius;
        if (sine >= 1) continue;
        const double cosine = std::sqrt(1 - sine * sine), height = (1 - cosine) * sphere_radius / radius;
        const double s = t + height * height;
        if (height < double{plane_tolerance} && cosine > double{normal_tolerance} && s < 1)
            covered += (1 - s) * (1 + cosine) / (2 * cosine);
    }
    return covered / whole;
}

void check_sphere(test::Checks &checks) {
    const World world(sphere(1, 512), 0.8f);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (const float radius : {0.1f, 0.3f, 0.5f, 0.6f}) {
        const Coverage coverage(world.scene, world.edges, with_radius(radius));
        for (int i = 0; i < 20; ++i) {
            const Vec3 direction = normalize(Vec3{uniform(random), uniform(random), 0.8f * uniform(random)});
            for (const float distance : {3.0f, 0.2f}) {  // from outside and from inside
                const Coverage::Disc disc = coverage.disc(world.met(direction * distance, direction), radius);
                checks.that(disc.radius == radius, "a disc that is mostly covered is used");
                checks.near(double{disc.share}, sphere_share(1, double{radius}), 0.03,
                            "share on a sphere at radius " + std::to_string(radius));
            }
        }
    }

    // Too large a disc is left for one of which six tenths are covered.
    const World small(sphere(0.1f, 64), 0.5f);
    const Coverage coverage(small.scene, small.edges, with_radius(0.5f));
    const Coverage::Disc disc = coverage.disc(small.met({3, 0.5f, 0.4f}, {}), 0.4f);
    checks.near(double{disc.share}, 0.6, 1e-3, "the least share that will do");
    checks.near(sphere_share(0.1, double{disc.radius}), 0.6, 0.05, "the radius that has it");
}

/// Two wide quads that meet at 20 degrees: no feature edge, and too wide to be taken for parts of a curved surface.
void check_bend(test::Checks &checks) {
    const float rise = std::tan(pi / 9);
    const World world(
        sheet(2, 1, [=](float u, float v) { return Vec3{2 * u - 1, v, std::max(0.0f, 2 * u - 1) * rise}; }), 0.1f);
    const Coverage coverage(world.scene, world.edges, with_radius(0.1f));
    // The rise passes the tolerance at 0.15 r / tan(20 degrees) = 0.412 r from the bend, where the point is: the share
    // beyond that of an Epanechnikov kernel is lost.
    const double h = 0.15 / std::tan(std::numbers::pi / 9);
    double lost = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
        const double x = h + (1 - h) * (i + 0.5) / steps;
        lost += 4.0 / 3 * std::pow(1 - x * x, 1.5) * (1 - h) / steps / (std::numbers::pi / 2);
    }
    const Coverage::Disc disc = coverage.disc(world.met({-0.02f, 0.5f, 1}, {-1e-4f, 0.5f, 0}), 0.1f);
    checks.near(double{disc.share}, 1 - lost, 0.08, "share at a bend");
    const Coverage::Disc away = coverage.disc(world.met({-0.3f, 0.5f, 1}, {-0.3f, 0.5f, 0}), 0.1f);
    checks.near(double{away.share}, 1, 1e-4, "share away from the bend");
}

}  // namespace

int main() {
    test::Checks checks;
    check_fine_plane(checks);
    check_sphere(checks);
    check_bend(checks);
    return checks.report();
}
