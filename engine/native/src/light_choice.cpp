// SPDX-License-Identifier: GPL-3.0-or-later
#include "light_choice.h"

namespace photon_maps {

namespace {

constexpr float below_one = 0x1.fffffep-1f;
constexpr uint32_t not_there = ~0u;

/// A node is opened where its squared distance is less than this many times the square of its radius: beyond, the
/// distances of what it holds differ little enough.
constexpr float open_within = 4;

/// What stands for all that a node holds: as far away as their centre of power, and never taken to be nearer than its
/// own radius.
struct StandIn {
    LightReach reach;
    float radius = 0;  ///< about the centre, of the sources' positions
};

StandIn stand_in_for(std::span<const StandIn> parts) {
    StandIn whole;
    whole.reach.floor = 0;
    Vec3 weighted;
    for (const auto &[part, radius] : parts) {
        whole.reach.factor += part.factor;
        whole.reach.constant += part.constant;
        weighted += part.position * part.factor;
    }
    if (!(whole.reach.factor > 0)) return {{{}, 0, 1, whole.reach.constant}, 0};
    whole.reach.position = weighted / whole.reach.factor;
    for (const auto &[part, radius] : parts) {
        if (!(part.factor > 0)) continue;
        whole.radius = std::max(whole.radius, length(part.position - whole.reach.position) + radius);
        whole.reach.floor = std::max(whole.reach.floor, part.floor);
    }
    whole.reach.floor = std::max(whole.reach.floor, whole.radius * whole.radius);
    return whole;
}

/// Which of parts laid end to end a number falls into: the last of them, whatever the rounding.
struct Pick {
    float left;        ///< of the number, within the part
    float weight = 0;  ///< of the part
    size_t part = 0;

    /// Lays another part; says whether the number falls into it.
    bool lay(size_t number, float part_weight) {
        if (!(part_weight > 0)) return false;
        left -= weight;
        weight = part_weight;
        part = number;
        return left < weight;
    }
};

}  // namespace

LightChoice::LightChoice(std::span<const LightReach> sources) : places_(sources.size(), not_there) {
    std::vector<uint32_t> bright;
    std::vector<Vec3> positions;
    for (uint32_t s = 0; s < sources.size(); ++s) {
        if (sources[s].is_dark()) continue;
        bright.push_back(s);
        positions.push_back(sources[s].position);
    }
    std::vector<StandIn> children;
    for (const uint32_t i : order_in_eights(positions)) {
        places_[bright[i]] = static_cast<uint32_t>(sources_.size());
        sources_.push_back(bright[i]);
        children.push_back({sources[bright[i]], 0});
    }
    do {
        std::vector<Reaches> &level = levels_.emplace_back(node_count(children.size()));
        std::vector<StandIn> above;
        for (size_t first = 0; first < children.size(); first += lanes) {
            const size_t count = std::min(lanes, children.size() - first);
            const auto parts = std::span<const StandIn>(children).subspan(first, count);
            for (size_t lane = 0; lane < count; ++lane) level[first / lanes].set(lane, parts[lane].reach);
            above.push_back(stand_in_for(parts));
        }
        children = std::move(above);
    } while (levels_.back().size() > top_nodes);
}

void LightChoice::Reaches::set(size_t lane, const LightReach &reach) {
    x[lane] = reach.position.x;
    y[lane] = reach.position.y;
    z[lane] = reach.position.z;
    factor[lane] = reach.factor;
    floor[lane] = reach.floor;
    constant[lane] = reach.constant;
}

[[gnu::always_inline]] inline Float8 LightChoice::Reaches::squared_distances(Vec3 position) const {
    const Float8 to_x = load(x) - broadcast(position.x), to_y = load(y) - broadcast(position.y),
                 to_z = load(z) - broadcast(position.z);
    return to_x * to_x + to_y * to_y + to_z * to_z;
}

[[gnu::always_inline]] inline Float8 LightChoice::Reaches::importances(Float8 squared_distances) const {
    return load(constant) + load(factor) / max(squared_distances, load(floor));
}

uint32_t LightChoice::sources_below(uint32_t level, uint32_t child) const {
    const uint64_t run = uint64_t{1} << 3 * level, first = child * run, all = sources_.size();
    return static_cast<uint32_t>(first < all ? std::min(run, all - first) : 0);
}

LightChoice::Chances LightChoice::at(Vec3 position) const {
    Chances chances;
    chances.position = position;
    vectorized([&] { open_near(chances); });
    float importance = 0;
    for (const Node &node : chances.nodes.values()) importance += node.importance;
    if (!(importance > 0)) return chances;
    chances.total = importance / (1 - even_share);
    chances.each = even_share / (1 - even_share) * importance / static_cast<float>(sources_.size());
    return chances;
}

/// Opens nodes from the highest down, of one level before those of the next, while there is room for them.
[[gnu::always_inline]] inline void LightChoice::open_near(Chances &chances) const {
    const auto top = static_cast<uint32_t>(levels_.size() - 1);
    for (uint32_t n = 0; n < levels_[top].size(); ++n) chances.nodes.emplace_back().place = {top, n};
    for (size_t n = 0; n < chances.nodes.size(); ++n) weigh(chances, n);
}

[[gnu::always_inline]] inline void LightChoice::weigh(Chances &chances, size_t number) const {
    Node &node = chances.nodes[number];
    const auto [level, place] = node.place;
    const Reaches &reaches = levels_[level][place];
    const Float8 squared = reaches.squared_distances(chances.position);
    Float8 importances = reaches.importances(squared);
    node.opened = {};
    node.sources = sources_below(level + 1, place);
    if (level > 0) {
        const Int8 has_place = load(reaches.factor) > broadcast(0);
        uint64_t near = bytes(has_place & (squared < broadcast(open_within) * load(reaches.floor)));
        while (near != 0 && !chances.nodes.full()) {
            const uint32_t lane = take_first(near), child = node.place.child(lane);
            chances.nodes.emplace_back().place = {level - 1, child};
            node.opened[lane] = true;
            node.sources -= sources_below(level, child);
            importances[lane] = 0;
        }
    }
    std::memcpy(node.importances.data(), &importances, sizeof importances);
    node.importance = photon_maps::total(importances);
}

/// Shares an importance among the children of a node.
Eight LightChoice::shared(float importance, NodePlace place, Vec3 position) const {
    const Reaches &reaches = levels_[place.level][place.number];
    Float8 parts = reaches.importances(reaches.squared_distances(position));
    const float sum = total(parts);
    parts *= broadcast(sum > 0 ? importance / sum : 0);
    Eight result;
    std::memcpy(result.data(), &parts, sizeof parts);
    return result;
}

std::optional<LightChoice::Choice> LightChoice::choose(const Chances &chances, float u) const {
    if (!(chances.total > 0)) return {};
    const std::span<const Node> nodes = chances.nodes.values();
    Pick of_nodes{u * chances.total};
    for (size_t n = 0; n < nodes.size(); ++n)
        if (of_nodes.lay(n, nodes[n].importance + chances.each * static_cast<float>(nodes[n].sources))) break;
    const Node &node = nodes[of_nodes.part];
    Eight importances = node.importances;
    NodePlace place = node.place;
    std::array<bool, lanes> opened = node.opened;
    Pick pick{of_nodes.left};
    while (true) {
        for (size_t lane = 0; lane < lanes; ++lane) {
            const uint32_t sources = opened[lane] ? 0 : sources_below(place.level, place.child(lane));
            if (sources > 0 && pick.lay(lane, importances[lane] + chances.each * static_cast<float>(sources))) break;
        }
        const uint32_t child = place.child(pick.part);
        if (place.level == 0)
            return Choice{sources_[child], pick.weight / chances.total, std::min(pick.left / pick.weight, below_one)};
        place = {place.level - 1, child};
        importances = shared(importances[pick.part], place, chances.position);
        opened = {};
        pick = {pick.left};
    }
}

float LightChoice::probability(const Chances &chances, size_t source) const {
    const uint32_t leaf = places_[source];
    if (leaf == not_there || !(chances.total > 0)) return 0;
    for (const Node &node : chances.nodes.values()) {
        const auto child_at = [&](uint32_t level) { return leaf >> 3 * level; };
        if (child_at(node.place.level + 1) != node.place.number) continue;
        uint32_t level = node.place.level;
        if (node.opened[child_at(level) % lanes]) continue;
        float importance = node.importances[child_at(level) % lanes];
        while (level-- > 0)
            importance = shared(importance, {level, child_at(level + 1)}, chances.position)[child_at(level) % lanes];
        return (importance + chances.each) / chances.total;
    }
    return 0;
}

}  // namespace photon_maps
