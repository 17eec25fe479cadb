// SPDX-License-Identifier: GPL-3.0-or-later
// Which buffer light belongs to, by the scatterings on its way: camera_path.h has the table.
#pragma once

#include "camera_pass.h"
#include "closure.h"

namespace photon_maps {

/// The scatterings of a path, from the eye on.
struct Word {
    uint32_t length = 0, diffuse = 0;
    bool ends_glossy = false;

    Word then(Lobes lobes) const {
        const bool is_diffuse = (lobes & diffuse_lobes) != 0;
        return {length + 1, diffuse + (is_diffuse ? 1 : 0), !is_diffuse};
    }

    /// The buffer that light arriving by this word belongs to.
    Vec3 &buffer(PixelSample &sample) const {
        if (length == 0) return sample.emission;
        if (length == 1) return sample.direct;
        return diffuse == 1 && ends_glossy ? sample.caustic : sample.indirect;
    }
};

}  // namespace photon_maps
