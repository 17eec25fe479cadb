// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of photons in whose place maps are built, made before the time is taken.
#pragma once

#include <utility>
#include <vector>

#include "photon.h"

namespace photon_maps {

class PhotonLists {
  public:
    /// @param count copies of the photons, with room for what a map adds to the last block
    PhotonLists(const std::vector<Photon> &photons, int count) : lists_(static_cast<size_t>(count)) {
        for (std::vector<Photon> &list : lists_) {
            list.reserve(photons.size() + lanes);
            list = photons;
        }
    }

    std::vector<Photon> take() {
        std::vector<Photon> list = std::move(lists_.back());
        lists_.pop_back();
        return list;
    }

  private:
    std::vector<std::vector<Photon>> lists_;
};

}  // namespace photon_maps
