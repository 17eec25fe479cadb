// SPDX-License-Identifier: GPL-3.0-or-later
// Which buffer light belongs to, by the scatterings on its way: camera_path.h has the table.
#pragma once

#include "camera_pass.h"
#include "closure.h"

namespace photon_maps {

/// The scatterings of a path, from the eye on.
struct Word {
    uint32_t length = 0, diffuse = 0;
    bool begins_glossy = false, ends_glossy = false;

    Word then(Lobes lobes) const {
        const bool is_diffuse = (lobes & diffuse_lobes) != 0;
        return {length + 1, diffuse + (is_diffuse ? 1 : 0), length == 0 ? !is_diffuse : begins_glossy, !is_diffuse};
    }

    /// The buffer that light arriving by this word belongs to.
    Vec3 &buffer(PixelSample &sample) const {
        if (length == 0) return sample.emission;
        if (length == 1) return sample.direct;
        if (diffuse == 1 && ends_glossy) return sample.caustic;
        return begins_glossy ? sample.specular : sample.soft_indirect;
    }
};

}  // namespace photon_maps
