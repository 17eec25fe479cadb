// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres about the lamps that rays can meet, eight at a time and in a tree: a ray is held against few of the lamps.
#pragma once

#include "eights.h"
#include "fixed_vector.h"
#include "scene.h"

namespace photon_maps {

/// A sphere that holds a lamp.
struct LampSphere {
    uint32_t lamp;
    Vec3 center;
    float radius;
};

class LampSpheres {
  public:
    explicit LampSpheres(std::span<const LampSphere> spheres);

    /// Calls visit(lamp) for each lamp whose sphere the ray meets, and perhaps for some that it just misses.
    template <class Visit>
    void visit(const Ray &ray, Visit &&visit) const {
        if (lamps_.empty()) return;
        const Line line(ray);
        FixedVector<NodePlace, 128> open;  // at most seven of each level below the highest, and eight of the last
        const auto top = static_cast<uint32_t>(levels_.size() - 1);
        for (uint32_t n = 0; n < levels_[top].size(); ++n) {
            open.emplace_back() = {top, n};
            while (!open.empty()) {
                const NodePlace place = open.values().back();
                open.pop_back();
                uint64_t met = levels_[place.level][place.number].met_by(line);
                while (met != 0) {
                    const uint32_t child = place.child(take_first(met));
                    if (place.level > 0)
                        open.emplace_back() = {place.level - 1, child};
                    else
                        visit(lamps_[child]);
                }
            }
        }
    }

  private:
    /// A ray by a unit direction.
    struct Line {
        Vec3 origin, direction;
        float far;

        explicit Line(const Ray &ray);
    };

    /// Eight spheres; those that are missing have a negative radius.
    struct Spheres {
        Eight x{}, y{}, z{}, radius{-1, -1, -1, -1, -1, -1, -1, -1};

        void set(size_t lane, const LampSphere &sphere);
        /// Returns bytes() of those that a line meets.
        uint64_t met_by(const Line &line) const;
    };

    std::vector<uint32_t> lamps_;               // in order of the tree
    std::vector<std::vector<Spheres>> levels_;  // from the lamps up
};

}  // namespace photon_maps
