// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader_closures.h"

#include "shader_math.h"
#include "surface.h"

namespace photon_maps {

namespace {

/// What is neither negative nor beyond what single precision bears; no number is 0.
Vec3 positive(Vec3 v) {
    return by_component([](float c) { return c > 0 ? std::min(c, max_radiance) : 0; }, v);
}

/// The arguments of a closure, made sound.
class Sound {
  public:
    Sound(const Operands &arguments, const ShaderPoint &point) : arguments_(arguments), point_(point) {}

    Vec3 color(size_t i) const { return positive(arguments_[i]); }
    float number(size_t i) const {
        const float v = arguments_.number(i);
        return std::isfinite(v) ? v : 0;
    }
    Vec3 normal(size_t i) const {
        const Vec3 n = arguments_[i];
        return std::abs(length_squared(n) - 1) < 1e-6f ? n : safe_normalize(n, shading_normal(point_));
    }

  private:
    const Operands &arguments_;
    const ShaderPoint &point_;
};

Principled principled(const Sound &a) {
    Principled p;
    p.base_color = a.color(PM_PRINCIPLED_BASE_COLOR);
    p.metallic = a.number(PM_PRINCIPLED_METALLIC);
    p.roughness = a.number(PM_PRINCIPLED_ROUGHNESS);
    p.ior = a.number(PM_PRINCIPLED_IOR);
    p.alpha = a.number(PM_PRINCIPLED_ALPHA);
    p.normal = a.normal(PM_PRINCIPLED_NORMAL);
    p.diffuse_roughness = a.number(PM_PRINCIPLED_DIFFUSE_ROUGHNESS);
    p.specular_level = a.number(PM_PRINCIPLED_SPECULAR_LEVEL);
    p.specular_tint = a.color(PM_PRINCIPLED_SPECULAR_TINT);
    p.transmission = a.number(PM_PRINCIPLED_TRANSMISSION);
    p.coat = a.number(PM_PRINCIPLED_COAT);
    p.coat_roughness = a.number(PM_PRINCIPLED_COAT_ROUGHNESS);
    p.coat_ior = a.number(PM_PRINCIPLED_COAT_IOR);
    p.coat_tint = a.color(PM_PRINCIPLED_COAT_TINT);
    p.coat_normal = a.normal(PM_PRINCIPLED_COAT_NORMAL);
    p.sheen = a.number(PM_PRINCIPLED_SHEEN);
    p.sheen_roughness = a.number(PM_PRINCIPLED_SHEEN_ROUGHNESS);
    p.sheen_tint = a.color(PM_PRINCIPLED_SHEEN_TINT);
    p.emission = a.color(PM_PRINCIPLED_EMISSION);
    return p;
}

}  // namespace

void add_closure(Shading &shading, const ShaderPoint &point, const pm_instruction &instruction,
                 const Operands &arguments) {
    const Sound a(arguments, point);
    const Vec3 weight = a.color(0);
    if (max_component(weight) <= 0) return;
    const bool is_multiple = instruction.option == PM_DISTRIBUTION_MULTI_GGX;
    switch (instruction.op) {
        case PM_OP_DIFFUSE:
            add_diffuse(shading, weight, a.number(1), a.normal(2));
            return;
        case PM_OP_TRANSLUCENT:
            add_translucent(shading, weight, a.normal(1));
            return;
        case PM_OP_SHEEN:
            add_sheen(shading, weight, a.number(1), a.normal(2));
            return;
        case PM_OP_GLOSSY:
            add_glossy(shading, weight, a.number(1), a.normal(2), is_multiple);
            return;
        case PM_OP_METALLIC:
            add_metallic(shading, weight, a.color(1), a.color(2), a.number(3), a.normal(4), is_multiple);
            return;
        case PM_OP_CONDUCTOR:
            add_conductor(shading, weight, a.color(1), a.color(2), a.number(3), a.normal(4), is_multiple);
            return;
        case PM_OP_GLASS:
            add_glass(shading, weight, a.color(1), a.number(2), a.number(3), a.normal(4), is_multiple);
            return;
        case PM_OP_REFRACTION:
            add_refraction(shading, weight, a.number(1), a.number(2), a.normal(3));
            return;
        case PM_OP_TRANSPARENT:
            shading.transparency += weight;
            return;
        case PM_OP_EMISSION:
            shading.emission += weight;
            return;
        case PM_OP_HOLDOUT:
            shading.holdout += average(weight);
            return;
        case PM_OP_PRINCIPLED:
            add_principled(shading, weight, principled(a), is_multiple);
            return;
        default:
            return;
    }
}

void add_transparency(Shading &shading, const pm_instruction &instruction, const Operands &arguments) {
    const Vec3 weight = positive(arguments[0]);
    const float share = instruction.op == PM_OP_TRANSPARENT  ? 1
                        : instruction.op == PM_OP_PRINCIPLED ? 1 - saturate(arguments.number(PM_PRINCIPLED_ALPHA))
                                                             : 0;
    shading.transparency += weight * share;
}

Vec3 world_radiance(const pm_instruction &instruction, const Operands &arguments) {
    return instruction.op == PM_OP_EMISSION ? positive(arguments[0]) : Vec3();
}

}  // namespace photon_maps
