// SPDX-License-Identifier: GPL-3.0-or-later
// The photon map against brute force, on photons that trees find hard.
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>

#include "check.h"
#include "parallel.h"
#include "photon_map.h"

using namespace photon_maps;

namespace {

/// Photons at given positions; their flux tells them apart.
std::vector<Photon> photons_at(const std::vector<Vec3> &positions) {
    std::vector<Photon> photons;
    for (size_t i = 0; i < positions.size(); ++i) {
        const auto number = static_cast<float>(i);
        const auto packed = static_cast<uint32_t>(i);
        photons.push_back({positions[i], {number, 2 * number, 3 * number}, packed, ~packed});
    }
    return photons;
}

using Sets = std::map<std::string, std::vector<Vec3>>;

Sets position_sets() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0, 1);
    const auto point = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    const auto many = [&](size_t count, const auto &make) {
        std::vector<Vec3> positions;
        for (size_t i = 0; i < count; ++i) positions.push_back(make(i));
        return positions;
    };
    Sets sets;
    sets["none"] = {};
    sets["one"] = {{1, 2, 3}};
    for (const size_t count : std::initializer_list<size_t>{2, 7, 8, 9, 31, 32, 33, 64, 65, 1000}) {
        sets["random " + std::to_string(count)] = many(count, [&](size_t) { return point(); });
    }
    sets["random 200000"] = many(200000, [&](size_t) { return point(); });
    sets["clustered"] = many(20000, [&](size_t i) { return i % 2 == 0 ? point() : point() * 0.1f; });
    sets["coplanar"] = many(5000, [&](size_t) { return point() * Vec3{1, 1, 0}; });
    sets["collinear"] = many(5000, [&](size_t) { return Vec3{0.5f, uniform(random), 0.25f}; });
    sets["duplicates"] = many(5000, [&](size_t i) { return i % 3 == 0 ? point() : Vec3{0.5f, 0.5f, 0.5f}; });
    sets["all the same"] = many(3000, [&](size_t) { return Vec3{0.25f, 0.5f, 0.75f}; });
    sets["lattice"] = many(4096, [&](size_t i) {
        return Vec3{static_cast<float>(i % 16), static_cast<float>(i / 16 % 16), static_cast<float>(i / 256)} / 16;
    });
    sets["huge"] = many(5000, [&](size_t) { return point() * 1e7f; });
    sets["tiny"] = many(5000, [&](size_t) { return point() * 1e-6f; });
    sets["far away"] = many(5000, [&](size_t) { return point() + Vec3{4096, -8192, 2048}; });
    return sets;
}

float distance_squared(const PhotonMap &map, size_t i, Vec3 p) {
    const Vec3 d = map.blocks()[i / lanes].position(i % lanes) - p;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// The map holds every photon once, whole.
void check_content(test::Checks &checks, const std::string &name, const PhotonMap &map,
                   const std::vector<Photon> &photons) {
    checks.that(map.size() == photons.size(), name + ": size");
    std::set<uint32_t> seen;
    bool whole = true;
    for (size_t i = 0; i < map.size(); ++i) {
        const PhotonBlock &block = map.blocks()[i / lanes];
        const size_t lane = i % lanes;
        const uint32_t original = block.normal[lane];
        seen.insert(original);
        if (original >= photons.size()) {
            whole = false;
            break;
        }
        const Photon &p = photons[original];
        whole = whole && block.position(lane) == p.position && block.flux(lane) == p.flux &&
                block.direction[lane] == p.direction;
    }
    checks.that(whole, name + ": photons are kept as they are");
    checks.that(seen.size() == photons.size(), name + ": every photon is kept once");
    bool is_padded = true;
    for (size_t i = map.size(); i < map.blocks().size() * lanes; ++i) {
        const PhotonBlock &last = map.blocks().back();
        is_padded = is_padded && last.x[i % lanes] == infinity && last.flux(i % lanes) == Vec3{};
    }
    checks.that(is_padded, name + ": what fills the last block is nowhere");
    checks.that(map.memory_bytes() >= 32 * map.size(), name + ": memory is counted");
}

/// Blocks are visited in their order, and hold every photon in range.
void check_range(test::Checks &checks, const std::string &name, const PhotonMap &map, Vec3 p, float radius) {
    std::vector<bool> visited(map.size());
    size_t previous_end = 0, visits = 0;
    bool ascending = true;
    map.visit_range(p, radius, [&](const PhotonBlock &block) {
        const size_t begin = static_cast<size_t>(&block - map.blocks().data()) * lanes;
        ascending = ascending && begin >= previous_end && begin < map.size();
        previous_end = begin + lanes;
        for (size_t i = begin; i < std::min(begin + lanes, map.size()); ++i) visited[i] = true;
        visits += lanes;
    });
    bool complete = true;
    size_t inside = 0;
    for (size_t i = 0; i < map.size(); ++i) {
        if (distance_squared(map, i, p) > radius * radius) continue;
        ++inside;
        complete = complete && visited[i];
    }
    checks.that(ascending, name + ": blocks are visited in their order");
    checks.that(complete, name + ": every photon in range is visited");
    if (map.size() == 200000) checks.that(visits < 10 * inside + 2000, name + ": few others are visited");
}

void check_nearest(test::Checks &checks, const std::string &name, const PhotonMap &map, Vec3 p, size_t k,
                   float max_radius) {
    std::vector<std::pair<float, uint32_t>> expected;
    for (uint32_t i = 0; i < map.size(); ++i) {
        const float d = distance_squared(map, i, p);
        if (d <= max_radius * max_radius) expected.emplace_back(d, i);
    }
    std::ranges::sort(expected);
    expected.resize(std::min(k, expected.size()));
    std::vector<Neighbor> neighbors{{-1, 0}};  // what was in it before must not matter
    map.nearest(p, k, max_radius, neighbors);
    std::vector<std::pair<float, uint32_t>> found;
    for (const Neighbor &n : neighbors) found.emplace_back(n.distance_squared, n.index);
    std::ranges::sort(found);
    checks.that(found == expected, name + ": the " + std::to_string(k) + " nearest");
}

bool same(const PhotonMap &a, const PhotonMap &b) {
    return a.size() == b.size() &&
           (a.size() == 0 || std::memcmp(a.blocks().data(), b.blocks().data(), a.blocks().size_bytes()) == 0);
}

}  // namespace

int main() {
    test::Checks checks;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);

    for (const auto &[name, positions] : position_sets()) {
        const std::vector<Photon> photons = photons_at(positions);
        const PhotonMap map(photons, 2, nullptr);
        check_content(checks, name, map, photons);
        for (const int threads : {1, 5}) {
            checks.that(same(map, PhotonMap(photons, threads, nullptr)), name + ": the same map for any thread count");
        }

        Vec3 low, high;
        if (!positions.empty()) low = high = positions[0];
        for (const Vec3 p : positions) {
            low = min(low, p);
            high = max(high, p);
        }
        const float extent = std::max(max_component(high - low), 1e-7f);
        for (int query = 0; query < 12; ++query) {
            // Inside, at a photon, and well outside.
            Vec3 p = low + Vec3{uniform(random), uniform(random), uniform(random)} * (high - low);
            if (query % 3 == 1 && !positions.empty()) p = positions[random() % positions.size()];
            if (query % 3 == 2) p = p + Vec3{2, -1, 0.5f} * (extent * uniform(random));
            const float radius = extent * std::pow(10.0f, -2 * uniform(random));
            check_range(checks, name, map, p, radius);
            check_range(checks, name, map, p, 0);
            check_range(checks, name, map, p, std::numeric_limits<float>::infinity());
            for (const size_t k : std::initializer_list<size_t>{0, 1, 8, 50, 1000}) {
                check_nearest(checks, name, map, p, k, std::numeric_limits<float>::infinity());
                check_nearest(checks, name, map, p, k, radius);
            }
            if (positions.size() < 10000) check_nearest(checks, name, map, p, positions.size() + 5, 4 * extent);
        }
    }

    const PhotonMap nothing;
    check_range(checks, "default", nothing, {}, 1);
    check_nearest(checks, "default", nothing, {}, 4, 1);

    // Cancelled before and while it builds.
    const std::vector<Photon> photons = photons_at(position_sets()["random 200000"]);
    const std::atomic<bool> cancel = true;
    bool cancelled = false;
    try {
        const PhotonMap map(photons, 2, &cancel);
    } catch (const Cancelled &) {
        cancelled = true;
    }
    checks.that(cancelled, "a cancelled build throws Cancelled");
    return checks.report();
}
