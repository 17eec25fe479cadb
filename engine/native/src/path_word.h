// SPDX-License-Identifier: GPL-3.0-or-later
// Which buffer light belongs to, by the scatterings on its way: camera_path.h has the table.
#pragma once

#include "camera_pass.h"
#include "closure.h"

namespace photon_maps {

/// What a surface scatters by, as words tell it apart.
enum Part : uint32_t { diffuse_part, rough_part, glossy_part };

/// Returns a surface's lobes by Part. Photons are kept on diffuse surfaces: others' rough reflections are as any glossy
/// ones.
/// @param has_caustics else all are
inline std::array<Lobes, 3> parts_of(const Shading &shading, bool has_caustics) {
    const Lobes lobes = lobes_of(shading), diffuse = lobes & diffuse_lobes;
    const Lobes rough = has_caustics && diffuse ? lobes & rough_reflection : 0;
    return {diffuse, rough, lobes & ~(diffuse | rough)};
}

/// The scatterings of a path, from the eye on.
struct Word {
    uint32_t length = 0, diffuse = 0;
    bool begins_glossy = false, ends_glossy = false;
    bool is_rough = false;    ///< once by a rough part
    bool is_focused = false;  ///< and glossily after that

    Word then(Part part) const {
        const bool is_diffuse = part == diffuse_part;
        return {length + 1,  diffuse + (is_diffuse ? 1 : 0), length == 0 ? !is_diffuse : begins_glossy,
                !is_diffuse, is_rough || part == rough_part, is_rough && !is_diffuse};
    }

    /// Whether the word is one of a caustic: light that glossy surfaces, at least one, sent to where a diffuse or a
    /// rough scattering shows it.
    bool is_caustic() const { return diffuse == 0 ? is_focused : diffuse == 1 && ends_glossy; }

    /// The buffer that light arriving by this word belongs to.
    Vec3 &buffer(PixelSample &sample) const {
        if (length == 0) return sample.emission;
        if (length == 1) return sample.direct;
        if (is_caustic()) return sample.caustic;
        return begins_glossy ? sample.specular : sample.soft_indirect;
    }
};

}  // namespace photon_maps
