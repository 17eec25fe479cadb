// SPDX-License-Identifier: GPL-3.0-or-later
// Programs at points of a triangle: what they read there, normals, folding, and what is known of them beforehand.
#include <vector>

#include "check.h"
#include "photon_maps_shader.h"
#include "scene.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

/// A program that grows; registers are numbered as it goes, so constants come first.
struct Builder {
    Material material;
    uint32_t next = 0;

    uint32_t constant(Vec3 value) {
        material.program.constants.push_back(value);
        return next++;
    }
    uint32_t add(uint32_t op, const std::vector<uint32_t> &arguments, uint32_t option = 0, uint32_t shift = 0,
                 uint32_t outputs = 1) {
        Program &p = material.program;
        p.instructions.push_back({op, option, shift, next, static_cast<uint32_t>(p.arguments.size()),
                                  static_cast<uint32_t>(arguments.size())});
        p.arguments.insert(p.arguments.end(), arguments.begin(), arguments.end());
        next += outputs;
        return next - outputs;
    }
};

/// The triangle (0,0,0), (2,0,0), (0,1,0), moved and turned by `place`, of one material.
struct Stage {
    Scene scene{nullptr};

    explicit Stage(Builder builder, const Transform &place = {}) {
        Mesh mesh;
        mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {}};
        mesh.triangles = {{0, 1, 2}};
        mesh.attributes = {{1, PM_DOMAIN_CORNER, 2, {0, 0, 1, 0, 0, 1}},
                           {2, PM_DOMAIN_VERTEX, 1, {1, 2, 4}},
                           {3, PM_DOMAIN_FACE, 4, {0.1f, 0.2f, 0.3f, 0.4f}},
                           {4, PM_DOMAIN_CORNER, 2, {1, 0, 0, 0, 1, 1}}};  // mirrored
        mesh.slot_count = 1;
        scene.meshes.push_back(std::move(mesh));
        Instance instance;
        instance.transform = instance.place = place;
        scene.instances.push_back(instance);
        scene.slot_materials = {0};
        prepare(builder.material, scene);
        scene.materials.push_back(std::move(builder.material));
        scene.freeze();
    }

    const Material &material() const { return scene.materials[0]; }
    Shading shade_at(float u, float v, Vec3 travel, RayState ray = {}) const {
        return shade(scene, scene.surface_point(0, 0, u, v, travel), -normalize(travel), ray);
    }
    Vec3 emission_at(float u, float v, Vec3 travel = {0, 0, -1}, RayState ray = {}) const {
        return shade_at(u, v, travel, ray).emission;
    }
};

void near(Checks &checks, Vec3 value, Vec3 expected, const char *what, double tolerance = 1e-5,
          Checks::Place place = Checks::Place::current()) {
    for (int axis = 0; axis < 3; ++axis) checks.near(value[axis], expected[axis], tolerance, what, place);
}

/// Shows a register, plus 1 so that directions are not cut at 0.
Builder shown(Builder b, uint32_t value, uint32_t one) {
    b.add(PM_OP_EMISSION, {b.add(PM_OP_MATH, {value, one}, PM_MATH_ADD)}, 0, 0, 0);
    return b;
}

Stage input_stage(pm_input kind, uint32_t shift = 0, const Transform &place = {}) {
    Builder b;
    const uint32_t one = b.constant({1, 1, 1});
    const uint32_t value = b.add(PM_OP_INPUT, {}, kind, shift);
    return Stage(shown(std::move(b), value, one), place);
}

Vec3 attribute_at(uint32_t id, uint32_t output, float u, float v) {
    Builder b;
    const uint32_t value = b.add(PM_OP_ATTRIBUTE, {}, id, 0, 2) + output;
    b.add(PM_OP_EMISSION, {value}, 0, 0, 0);
    return Stage(std::move(b)).emission_at(u, v);
}

void test_attributes_by_domain(Checks &checks) {
    near(checks, attribute_at(1, 0, 0.25f, 0.5f), {0.25f, 0.5f, 0}, "corners");
    near(checks, attribute_at(2, 0, 0.25f, 0.5f), {2.75f, 2.75f, 2.75f}, "vertices, a number three times");
    near(checks, attribute_at(3, 0, 0.25f, 0.5f), {0.1f, 0.2f, 0.3f}, "faces");
    near(checks, attribute_at(3, 1, 0.25f, 0.5f), {0.4f, 0.4f, 0.4f}, "alpha");
    near(checks, attribute_at(2, 1, 0.25f, 0.5f), {1, 1, 1}, "alpha of what has none");
    near(checks, attribute_at(9, 0, 0.25f, 0.5f), {0, 0, 0}, "no such attribute");
    near(checks, attribute_at(9, 1, 0.25f, 0.5f), {0, 0, 0}, "no such attribute's alpha");
}

void test_geometry(Checks &checks) {
    // Turned a quarter about x, twice as large, and moved: object (x, y, z) is at (2x + 1, -2z, 2y).
    const Transform place{{2, 0, 0}, {0, 0, 2}, {0, -2, 0}, {1, 0, 0}};
    const Vec3 one{1, 1, 1}, travel{0, 1, 0};
    const auto at = [&](pm_input kind) { return input_stage(kind, 0, place).emission_at(0.25f, 0.5f, travel) - one; };
    near(checks, at(PM_INPUT_POSITION), {2, 0, 1}, "position");
    near(checks, at(PM_INPUT_OBJECT_POSITION), {0.5f, 0.5f, 0}, "object position");
    near(checks, at(PM_INPUT_NORMAL), {0, -1, 0}, "normal");
    near(checks, at(PM_INPUT_OBJECT_NORMAL), {0, 0, 1}, "object normal");
    near(checks, at(PM_INPUT_INCOMING), {0, -1, 0}, "incoming");
    near(checks, at(PM_INPUT_PARAMETRIC), {0.25f, 0.25f, 0}, "Blender's barycentric coordinates");
    near(checks, at(PM_INPUT_REFLECTION), {0, -1, 0}, "reflection");
    near(checks, at(PM_INPUT_OBJECT_LOCATION), {1, 0, 0}, "location");
    near(checks, at(PM_INPUT_BACKFACING), {0, 0, 0}, "front");
    near(checks, input_stage(PM_INPUT_BACKFACING).emission_at(0.2f, 0.2f, {0, 0, 1}), {2, 2, 2}, "back");
    near(checks, input_stage(PM_INPUT_NORMAL).emission_at(0.2f, 0.2f, {0, 0, 1}) - one, {0, 0, -1}, "seen from behind");
}

void test_the_view(Checks &checks) {
    Stage stage = input_stage(PM_INPUT_WINDOW);
    stage.scene.view.world_to_camera.origin = {0, 0, -2};  // the camera stands at z = 2 and looks down
    near(checks, stage.emission_at(0.5f, 0) - Vec3{1, 1, 1}, {0.75f, 0.5f, 0}, "window of a perspective");
    stage.scene.view.type = PM_CAMERA_ORTHOGRAPHIC;
    near(checks, stage.emission_at(0.25f, 0) - Vec3{1, 1, 1}, {0.75f, 0.5f, 0}, "window of a parallel view");
    Stage camera = input_stage(PM_INPUT_CAMERA_POSITION);
    camera.scene.view.world_to_camera.origin = {0, 0, -2};
    near(checks, camera.emission_at(0.5f, 0.25f) - Vec3{1, 1, 1}, {1, 0.25f, 2}, "it looks along +z");
}

void test_steps_along_the_surface(Checks &checks) {
    RayState ray;
    ray.footprint = 0.5f;
    const Vec3 here = input_stage(PM_INPUT_POSITION).emission_at(0.25f, 0.25f, {0, 0, -1}, ray);
    std::array<Vec3, 2> steps;
    for (uint32_t shift = 1; shift <= 2; ++shift) {
        const Vec3 moved = input_stage(PM_INPUT_POSITION, shift).emission_at(0.25f, 0.25f, {0, 0, -1}, ray);
        steps[shift - 1] = moved - here;
        checks.near(length(moved - here), 0.05, 1e-5, "a tenth of the footprint");
        // Barycentric coordinates move along: (2u, v) is the place in the plane.
        const Vec3 parametric = input_stage(PM_INPUT_PARAMETRIC, shift).emission_at(0.25f, 0.25f, {0, 0, -1}, ray);
        const float u = parametric.y - 1, v = 1 - (parametric.x - 1) - u;
        near(checks, {2 * u, v, 0}, moved - Vec3{1, 1, 1}, "barycentric coordinates lead there");
    }
    checks.near(dot(steps[0], steps[1]), 0, 1e-6, "at right angles");
}

/// The normal that PM_OP_BUMP makes of a height that grows by `slope` a unit along x.
Vec3 bumped(float slope, float strength, float distance, bool is_inverted, Vec3 travel) {
    Builder b;
    const uint32_t one = b.constant({1, 1, 1}), s = b.constant({strength, strength, strength});
    const uint32_t d = b.constant({distance, distance, distance}), k = b.constant({slope, slope, slope});
    std::vector<uint32_t> arguments = {s, d};
    for (uint32_t shift = 0; shift < 3; ++shift) {
        const uint32_t x = b.add(PM_OP_COMPONENT, {b.add(PM_OP_INPUT, {}, PM_INPUT_POSITION, shift)}, 0);
        arguments.push_back(b.add(PM_OP_MATH, {x, k}, PM_MATH_MULTIPLY));
    }
    arguments.push_back(b.add(PM_OP_INPUT, {}, PM_INPUT_NORMAL));
    const uint32_t normal = b.add(PM_OP_BUMP, arguments, is_inverted ? 1 : 0);
    const Stage stage(shown(std::move(b), normal, one));
    return stage.emission_at(0.25f, 0.25f, travel) - Vec3{1, 1, 1};
}

void test_bumps_tilt_the_normal_by_the_slope(Checks &checks) {
    const Vec3 down{0, 0, -1};
    near(checks, bumped(0.5f, 1, 1, false, down), normalize({-0.5f, 0, 1}), "slope", 2e-3);
    near(checks, bumped(0.5f, 1, 0.1f, false, down), normalize({-0.05f, 0, 1}), "distance scales it", 2e-3);
    near(checks, bumped(0.5f, 1, 1, true, down), normalize({0.5f, 0, 1}), "inverted", 2e-3);
    near(checks, bumped(0.5f, 0, 1, false, down), {0, 0, 1}, "strength 0 is none", 2e-3);
    near(checks, bumped(0.5f, 1, 1, false, {0, 0, 1}), normalize({-0.5f, 0, -1}), "from behind, outwards too", 2e-3);
}

Vec3 mapped(uint32_t space, uint32_t uv, Vec3 color, float strength, Vec3 travel, const Transform &place = {}) {
    Builder b;
    const uint32_t one = b.constant({1, 1, 1}), s = b.constant({strength, strength, strength});
    const uint32_t c = b.constant(color);
    const uint32_t normal = b.add(PM_OP_NORMAL_MAP, {s, c}, space | uv << 8);
    return Stage(shown(std::move(b), normal, one), place).emission_at(0.25f, 0.25f, travel) - Vec3{1, 1, 1};
}

void test_normal_maps(Checks &checks) {
    const Vec3 down{0, 0, -1}, color{0.8f, 0.7f, 0.9f}, tilted = normalize({0.6f, 0.4f, 0.8f});
    near(checks, mapped(PM_NORMAL_TANGENT, 1, {0.5f, 0.5f, 1}, 1, down), {0, 0, 1}, "flat blue");
    near(checks, mapped(PM_NORMAL_TANGENT, 1, color, 1, down), tilted, "u along x, v along y");
    near(checks, mapped(PM_NORMAL_TANGENT, 1, color, 1, {0, 0, 1}), -tilted, "from behind");
    // UV 4 is (1 - x / 2, y): u grows against x, v with y, and the map shows its other side.
    near(checks, mapped(PM_NORMAL_TANGENT, 4, color, 1, down), {-tilted.x, tilted.y, tilted.z}, "mirrored");
    near(checks, mapped(PM_NORMAL_TANGENT, 9, color, 1, down), {0, 0, 1}, "no UV map: as it was");
    near(checks, mapped(PM_NORMAL_TANGENT, 1, color, 0, down), {0, 0, 1}, "strength 0");
    near(checks, mapped(PM_NORMAL_TANGENT, 1, color, 0.5f, down), normalize({0.3f, 0.2f, 0.9f}), "half strength");
    const Transform turned{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {}};
    near(checks, mapped(PM_NORMAL_TANGENT, 1, color, 1, down, turned), {-tilted.y, tilted.x, tilted.z}, "turned");
    near(checks, mapped(PM_NORMAL_OBJECT, 0, color, 1, down, turned), {-tilted.y, tilted.x, tilted.z}, "object space");
    near(checks, mapped(PM_NORMAL_WORLD, 0, color, 1, down, turned), tilted, "world space");
}

void test_fresnel(Checks &checks) {
    Builder b;
    const uint32_t ior = b.constant({1.5f, 1.5f, 1.5f});
    const uint32_t normal = b.add(PM_OP_INPUT, {}, PM_INPUT_NORMAL);
    b.add(PM_OP_EMISSION, {b.add(PM_OP_FRESNEL, {ior, normal})}, 0, 0, 0);
    const Stage stage(std::move(b));
    checks.near(stage.emission_at(0.2f, 0.2f).x, 0.04, 1e-6, "head on");
    const double c = 0.5, g = std::sqrt(1.5 * 1.5 - 0.75);  // at 60 degrees; g is n times the refracted cosine
    const double s = (c - g) / (c + g), p = (1.5 * 1.5 * c - g) / (1.5 * 1.5 * c + g);
    const Vec3 slanted{std::sqrt(0.75f), 0, -0.5f};
    checks.near(stage.emission_at(0.2f, 0.2f, slanted).x, 0.5 * (s * s + p * p), 1e-6, "Fresnel's equations");
    const Vec3 grazing_inside{std::sqrt(0.75f), 0, 0.5f};
    checks.near(stage.emission_at(0.2f, 0.2f, grazing_inside).x, 1, 1e-6, "total reflection from within");
}

void test_what_is_constant_is_folded(Checks &checks) {
    Builder b;
    const uint32_t two = b.constant({2, 2, 2}), three = b.constant({3, 3, 3}), zero = b.constant({0, 0, 0});
    const uint32_t position = b.add(PM_OP_INPUT, {}, PM_INPUT_POSITION);  // nothing depends on it but what is dropped
    const uint32_t sum = b.add(PM_OP_MATH, {two, three}, PM_MATH_ADD);
    const uint32_t none = b.add(PM_OP_MATH, {zero, position}, PM_MATH_MULTIPLY);
    const uint32_t same = b.add(PM_OP_MIX, {zero, sum, position});
    b.add(PM_OP_EMISSION, {same}, 0, 0, 0);
    b.add(PM_OP_TRANSPARENT, {none}, 0, 0, 0);
    const Stage stage(std::move(b));
    checks.that(stage.material().program.instructions.size() == 1, "the emission alone is left");
    checks.that(stage.material().program.register_count == 1, "and its constant");
    checks.that(stage.material().traits.is_constant && stage.material().traits.emits, "it is constant");
    checks.that(!stage.material().traits.is_transparent, "a closure of no weight is none");
    near(checks, stage.emission_at(0.2f, 0.2f), {5, 5, 5}, "the value is that of the instructions");
}

void test_traits(Checks &checks) {
    const auto traits_of = [](uint32_t op, const std::vector<Vec3> &constants) {
        Builder b;
        std::vector<uint32_t> arguments;
        for (const Vec3 c : constants) arguments.push_back(b.constant(c));
        arguments.push_back(b.add(PM_OP_INPUT, {}, PM_INPUT_NORMAL));
        b.add(op, arguments, 0, 0, 0);
        return Stage(std::move(b)).material().traits;
    };
    const Vec3 one{1, 1, 1}, half{0.5f, 0.5f, 0.5f};
    checks.that(traits_of(PM_OP_DIFFUSE, {half, {}}).lobes == diffuse_reflection, "diffuse");
    checks.that(traits_of(PM_OP_TRANSLUCENT, {half}).lobes == diffuse_transmission, "translucent");
    checks.that(traits_of(PM_OP_DIFFUSE, {half, {}}).is_reciprocal, "Lambert's law is the same both ways");
    checks.that(!traits_of(PM_OP_SHEEN, {half, half}).is_reciprocal, "sheen depends on the side it is seen from");
    const MaterialTraits glass = traits_of(PM_OP_GLASS, {one, one, {}, one * 1.5f});
    checks.that(glass.lobes == (glossy_reflection | glossy_transmission) && glass.specular == 1 && glass.may_scatter,
                "glass");

    // Principled's defaults, in the order of pm_principled.
    Builder b;
    std::vector<uint32_t> arguments;
    std::array<Vec3, PM_PRINCIPLED_ARGUMENT_COUNT> values = {one, one * 0.8f, {},  half, one * 1.5f, one, {},
                                                             {},  half,       one, {},   {},         {},  one * 1.5f,
                                                             one, {},         {},  half, one,        {}};
    for (const Vec3 value : values) arguments.push_back(b.constant(value));
    const uint32_t normal = b.add(PM_OP_INPUT, {}, PM_INPUT_NORMAL);
    arguments[PM_PRINCIPLED_NORMAL] = arguments[PM_PRINCIPLED_COAT_NORMAL] = normal;
    Builder clear = b;
    b.add(PM_OP_PRINCIPLED, arguments, 0, 0, 0);
    const Stage principled(std::move(b));
    const MaterialTraits traits = principled.material().traits;
    checks.that(traits.lobes == (diffuse_reflection | glossy_reflection), "principled's lobes");
    checks.that(!traits.is_reciprocal, "what is below a layer depends on the side it is seen from");
    checks.near(traits.specular, 0.04, 1e-3, "principled's sheen of light");
    checks.that(!traits.emits && !traits.is_transparent && traits.is_constant,
                "principled neither shines nor is clear");
    checks.that(principled.material().transparency.instructions.empty(), "shadow rays need none of it");

    arguments[PM_PRINCIPLED_ALPHA] = clear.add(PM_OP_ATTRIBUTE, {}, 1, 0, 2);
    clear.add(PM_OP_PRINCIPLED, arguments, 0, 0, 0);
    const Stage window(std::move(clear));
    checks.that(window.material().traits.is_transparent && !window.material().traits.is_constant, "alpha that varies");
    RayState shadow;
    shadow.kinds = 1u << PM_RAY_SHADOW;
    near(checks, window.shade_at(0.25f, 0.5f, {0, 0, -1}, shadow).transparency, {0.75f, 0.75f, 0.75f}, "1 - alpha");
}

void test_what_is_no_number_does_not_get_out(Checks &checks) {
    Builder b;
    const uint32_t huge = b.constant({1e15f, 1e15f, 1e15f});
    const uint32_t x = b.add(PM_OP_INPUT, {}, PM_INPUT_POSITION);
    const uint32_t infinite =
        b.add(PM_OP_MATH, {b.add(PM_OP_MATH, {huge, huge}, PM_MATH_MULTIPLY), huge}, PM_MATH_MULTIPLY);
    const uint32_t never = b.add(PM_OP_MATH, {infinite, infinite}, PM_MATH_SUBTRACT);
    const uint32_t weight = b.add(PM_OP_COMBINE, {never, infinite, b.add(PM_OP_COMPONENT, {x}, 0)});
    for (const uint32_t op : {PM_OP_EMISSION, PM_OP_TRANSPARENT, PM_OP_HOLDOUT}) b.add(op, {weight}, 0, 0, 0);
    b.add(PM_OP_DIFFUSE, {weight, never, never}, 0, 0, 0);
    const Shading shading = Stage(std::move(b)).shade_at(0.25f, 0.25f, {0, 0, -1});
    near(checks, shading.emission, {0, 1e15f, 0.5f}, "emission is cut");
    near(checks, shading.transparency, {0, 1, 0.5f}, "no more than all passes");
    checks.that(shading.holdout == 1, "no more than a hole");
    checks.that(shading.closures.size() == 1 && shading.scattering()[0].normal == Vec3{0, 0, 1},
                "the point's own normal");
}

void test_the_world_is_asked_by_direction(Checks &checks) {
    const Vec3 d = normalize({1, 2, 3}), one{1, 1, 1};
    const auto at = [&](pm_input kind) {
        const Stage stage = input_stage(kind);
        return shade_world(stage.scene, stage.material(), d, {}) - one;
    };
    near(checks, at(PM_INPUT_POSITION), d, "position");
    near(checks, at(PM_INPUT_OBJECT_POSITION), d, "object position");
    near(checks, at(PM_INPUT_NORMAL), -d, "normal");
    near(checks, at(PM_INPUT_INCOMING), -d, "incoming");
    near(checks, at(PM_INPUT_OBJECT_INDEX), {}, "no object");
}

}  // namespace

int main() {
    Checks checks;
    test_attributes_by_domain(checks);
    test_geometry(checks);
    test_the_view(checks);
    test_steps_along_the_surface(checks);
    test_bumps_tilt_the_normal_by_the_slope(checks);
    test_normal_maps(checks);
    test_fresnel(checks);
    test_what_is_constant_is_folded(checks);
    test_traits(checks);
    test_what_is_no_number_does_not_get_out(checks);
    test_the_world_is_asked_by_direction(checks);
    return checks.report();
}
