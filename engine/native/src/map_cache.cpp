// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_cache.h"

namespace photon_maps {

size_t TracedPass::memory_bytes() const {
    return sizeof(TracedPass) + photons.size() * sizeof(Photon) + photons.shadow_photons.size() * sizeof(ShadowPhoton) +
           maps.global.memory_bytes() + maps.caustic.memory_bytes() +
           (maps.importance ? maps.importance->memory_bytes() : 0) +
           (maps.shadow_photons ? maps.shadow_photons->memory_bytes() : 0);
}

void MapCache::set_limit(size_t bytes) {
    limit_ = bytes;
    make_way();
}

std::shared_ptr<const TracedPass> MapCache::find(uint32_t index) const {
    const auto found = passes_.find(index);
    return found == passes_.end() ? nullptr : found->second;
}

void MapCache::keep(uint32_t index, std::shared_ptr<const TracedPass> pass) {
    if (limit_ == 0 || passes_.contains(index)) return;
    memory_bytes_ += pass->memory_bytes();
    passes_.emplace(index, std::move(pass));
    make_way();
}

/// Every picture begins with the first passes: those stay.
void MapCache::make_way() {
    while (memory_bytes_ > limit_) {
        const auto last = std::prev(passes_.end());
        memory_bytes_ -= last->second->memory_bytes();
        passes_.erase(last);
    }
}

}  // namespace photon_maps
