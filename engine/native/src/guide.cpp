// SPDX-License-Identifier: GPL-3.0-or-later
#include "guide.h"

#include <algorithm>

#include "sampling.h"
#include "sequence.h"

namespace photon_maps {

namespace {

/// Chance of a direction from the guide: half, so that no direction is drawn less than half as often as without.
constexpr float guided_share = 0.5f;

/// Photons that each cell is taken to have received before any was counted.
constexpr float prior_photons = 0.5f;

/// Normals that are told apart: five levels along each octahedral coordinate, so that the axes are among them.
constexpr int normal_levels = 5;

/// A normal, as photons have it, as one of those that are told apart. Not one in full precision: by the sign of what
/// should be zero the octahedron has -z in either of four corners.
uint32_t normal_level(uint32_t packed_normal) {
    const uint32_t packed = pack_direction(normalize(unpack_normal(packed_normal)));
    const auto level = [](uint32_t v) { return (v * (normal_levels - 1) + 32767) / 65534; };
    return level(packed & 0xffff) * normal_levels + level(packed >> 16);
}

Vec3 normal_of_level(uint32_t level) {
    const auto coordinate = [](uint32_t l) { return l * 65534 / (normal_levels - 1); };
    return unpack_direction(coordinate(level / normal_levels) | coordinate(level % normal_levels) << 16);
}

uint64_t place_of(Vec3 position, float cube_size, uint32_t normal_level) {
    // 19 bits an axis: farther cubes share a place with nearer ones, which makes guides worse and nothing wrong.
    const auto axis = [cube_size](float v) {
        return static_cast<uint64_t>(static_cast<int64_t>(std::floor(v / cube_size))) & 0x7ffff;
    };
    return axis(position.x) | axis(position.y) << 19 | axis(position.z) << 38 | uint64_t{normal_level} << 57;
}

/// The cell that a direction about +z comes from by sample_cosine_hemisphere().
size_t cell_of(Vec3 local) {
    constexpr size_t width = IncomingFlux::width;
    const Vec2 square = disk_to_square({local.x, local.y});
    const auto index = [](float t) { return std::min(static_cast<size_t>(t * float{width}), width - 1); };
    return index(square.y) * width + index(square.x);
}

Vec3 direction_in_cell(size_t cell, float u, float v) {
    constexpr size_t width = IncomingFlux::width;
    const auto column = static_cast<float>(cell % width), row = static_cast<float>(cell / width);
    return sample_cosine_hemisphere((column + u) / float{width}, (row + v) / float{width});
}

}  // namespace

void PhotonImportance::add(std::span<const Photon> photons) {
    for (const Photon &photon : photons) {
        const uint32_t level = normal_level(photon.normal);
        const uint64_t place = place_of(photon.position, cube_size_, level);
        const auto [entry, is_new] = index_.try_emplace(place, static_cast<uint32_t>(places_.size()));
        if (is_new) places_.push_back({normal_of_level(level)});
        IncomingFlux &incoming = places_[entry->second];
        const Vec3 local = Frame(incoming.normal).to_local(-unpack_direction(photon.direction));
        if (local.z <= 0) continue;
        const float flux = average(photon.flux);
        incoming.flux[cell_of(local)] += flux;
        incoming.total += flux;
        ++incoming.photons;
    }
}

const IncomingFlux *PhotonImportance::around(const SurfacePoint &point, float u, float v) const {
    constexpr uint32_t enough = 16;
    const Frame frame(point.normal);
    const Vec3 near = point.position + (frame.x * (u - 0.5f) + frame.y * (v - 0.5f)) * cube_size_;
    const uint32_t level = normal_level(pack_normal(point.normal, 0));
    const auto entry = index_.find(place_of(near, cube_size_, level));
    if (entry == index_.end()) return nullptr;
    const IncomingFlux &incoming = places_[entry->second];
    return incoming.photons >= enough && incoming.total > 0 ? &incoming : nullptr;
}

size_t PhotonImportance::memory_bytes() const {
    return places_.size() * sizeof(IncomingFlux) + index_.size() * 2 * sizeof(*index_.begin());
}

Guide::Guide(const IncomingFlux &incoming, const Shading &shading) : frame_(incoming.normal) {
    const float prior = prior_photons * incoming.total / static_cast<float>(incoming.photons);
    const bool weighs_closures = std::ranges::any_of(shading.scattering(), [](const Closure &closure) {
        return (closure.type == ClosureType::diffuse && !is_lambertian(closure)) || closure.type == ClosureType::sheen;
    });
    for (size_t cell = 0; cell < weights_.size(); ++cell) {
        float weight = incoming.flux[cell] + prior;
        if (weighs_closures) {
            const Vec3 local = direction_in_cell(cell, 0.5f, 0.5f);
            const Vec3 scattered = evaluate(shading, diffuse_reflection, frame_.to_world(local), Transport::radiance);
            weight *= average(scattered) / local.z;
        }
        weights_[cell] = weight;
        total_ += weight;
    }
}

Vec3 Guide::sample(float u, float v) const {
    // A cell by its weight, a point of it by what is left of the number.
    float left = u * total_;
    size_t cell = 0;
    while (cell + 1 < weights_.size() && left >= weights_[cell]) left -= weights_[cell++];
    constexpr float almost_one = 0x1.fffffep-1f;
    return frame_.to_world(direction_in_cell(cell, std::min(left / weights_[cell], almost_one), v));
}

float Guide::pdf(Vec3 direction) const {
    const Vec3 local = frame_.to_local(direction);
    if (local.z <= 0 || !(total_ > 0)) return 0;
    return weights_[cell_of(local)] / total_ * float{IncomingFlux::cell_count} * local.z / pi;
}

std::optional<ScatterSample> sample_guided(const Guide &guide, const Shading &shading, const std::array<float, 3> &u) {
    ScatterSample drawn{};
    if (u[2] < guided_share) {
        drawn.direction = guide.sample(u[0], u[1]);
        // Its hemisphere is about one of few normals, and may reach below the surface.
        drawn.lobe = dot(drawn.direction, shading.normal) > 0 ? diffuse_reflection : diffuse_transmission;
    } else {
        const float left = (u[2] - guided_share) / (1 - guided_share);
        const auto unguided = sample(shading, diffuse_lobes, {u[0], u[1], left}, Transport::radiance);
        if (!unguided) return std::nullopt;
        drawn = *unguided;
    }
    drawn.pdf = pdf_guided(guide, shading, drawn.direction);
    if (!(drawn.pdf > 0)) return std::nullopt;
    drawn.weight = evaluate(shading, diffuse_lobes, drawn.direction, Transport::radiance) / drawn.pdf;
    return drawn;
}

float pdf_guided(const Guide &guide, const Shading &shading, Vec3 direction) {
    return guided_share * guide.pdf(direction) + (1 - guided_share) * pdf(shading, diffuse_lobes, direction);
}

}  // namespace photon_maps
