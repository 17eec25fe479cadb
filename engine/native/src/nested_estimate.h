// SPDX-License-Identifier: GPL-3.0-or-later
// The estimate by eight nested radii at once, of which one is chosen when the picture is read: nested_film.h.
#pragma once

#include "estimate.h"
#include "levels.h"

namespace photon_maps {

/// The disc of each level.
struct LevelDiscs {
    Float8 radius;
    Float8 share;  ///< of the kernel's integral that the surface brings, as Coverage::Disc
};

/// Estimates at a point by eight radii what estimate_photons does by one. Barriers are those of the largest disc: they
/// bound the smaller ones too, and what each has lost is measured. A query's closures weigh every photon by itself,
/// Query::mean_direction is not looked at.
/// @param kernel its radius is not used
/// @throws std::invalid_argument if a disc is larger than `edges` was built for
Levels estimate_levels(const PhotonMap &map, const EdgeIndex &edges, const Query &query, const Kernel &kernel,
                       const LevelDiscs &discs);

}  // namespace photon_maps
