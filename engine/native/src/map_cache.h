// SPDX-License-Identifier: GPL-3.0-or-later
// Pass 1 of the passes rendered so far: it depends on no camera, so pictures from elsewhere share it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "guide.h"
#include "photon_map.h"
#include "photon_trace.h"
#include "shadow_photons.h"

namespace photon_maps {

/// What pass 2 asks of a pass's photons.
struct Maps {
    PhotonMap global, caustic;
    std::optional<PhotonImportance> importance;
    std::optional<ShadowPhotons> shadow_photons;
    size_t memory_bytes = 0;  ///< at its peak, with the lists that they were built from
};

/// What pass 1 leaves.
struct TracedPass {
    TracedPhotons photons;  ///< what was counted of them; their lists if they are kept
    uint64_t photons_stored = 0, caustic_photons = 0;
    Maps maps;

    /// Of what stays, without the lists that are gone.
    size_t memory_bytes() const;
};

/// Traced passes by their index, the earliest of them, within a limit of memory.
class MapCache {
  public:
    /// Bytes from now on; what is kept beyond them goes.
    void set_limit(size_t bytes);
    /// The pass, or null if it is not kept.
    std::shared_ptr<const TracedPass> find(uint32_t index) const;
    /// Keeps a pass where there is room for it beside those before it; later ones make way.
    void keep(uint32_t index, std::shared_ptr<const TracedPass> pass);
    size_t memory_bytes() const { return memory_bytes_; }
    size_t limit() const { return limit_; }

  private:
    void make_way();

    std::map<uint32_t, std::shared_ptr<const TracedPass>> passes_;
    size_t limit_ = 0, memory_bytes_ = 0;
};

}  // namespace photon_maps
