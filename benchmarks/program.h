// SPDX-License-Identifier: GPL-3.0-or-later
// What the programs have in common that measure with Embree.
#pragma once

#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>

#include "embree.h"
#include "measure.h"

namespace bench {

/// The whole of a program: measures by the Embree that the environment variable PHOTON_MAPS_EMBREE names, for the
/// number of rounds that its first argument asks.
inline void run_with_embree(int argc, char **argv,
                            const std::function<void(const std::shared_ptr<photon_maps::Embree> &, int rounds)> &run) {
    const char *path = std::getenv("PHOTON_MAPS_EMBREE");
    require(path, "set the environment variable PHOTON_MAPS_EMBREE to an Embree 4 library");
    print_machine();
    try {
        run(std::make_shared<photon_maps::Embree>(path), rounds_asked(argc, argv));
    } catch (const std::exception &error) {
        require(false, error.what());
    }
}

}  // namespace bench
