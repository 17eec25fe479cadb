// SPDX-License-Identifier: GPL-3.0-or-later
// Photons as they leave the lights: from all lights over the whole scene, or aimed at what can focus light
// (Jensen 1996, section 4.1, whose projection maps are here spheres about the casters).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "caster.h"
#include "lamp_emission.h"
#include "light.h"
#include "sequence.h"

namespace photon_maps {

/// Chances by which to choose among things.
class Choices {
  public:
    void add(double weight) { cumulative_.push_back(total() + weight); }
    double total() const { return cumulative_.empty() ? 0 : cumulative_.back(); }
    size_t size() const { return cumulative_.size(); }
    double weight(size_t i) const { return cumulative_[i] - (i > 0 ? cumulative_[i - 1] : 0); }
    double probability(size_t i) const { return weight(i) / total(); }
    /// @param u uniform in [0, 1)
    size_t choose(double u) const;

  private:
    std::vector<double> cumulative_;
};

/// Emits photons from all lights of a scene; both must outlive it.
class Emission {
  public:
    Emission(const Scene &scene, const Lights &lights);

    /// Whether there is no light to emit.
    bool empty() const { return !(by_power_.total() > 0); }

    /// Emits one photon: a light by its share of the power and a little by their number (even_share), then a point and
    /// direction by its radiance. Nothing if the lights have no power.
    std::optional<PhotonEmission> emit(Sequence &sequence) const { return emit(by_power_, {}, sequence); }

    /// Whether there is anything that can focus light.
    bool has_casters() const { return !casters_.empty(); }
    uint32_t caster_count() const { return static_cast<uint32_t>(casters_.size()); }

    /// Emits one photon, most of them towards the casters: light and caster by the flux that passes from one to the
    /// other and the share that the caster scatters glossily. Flux is that of emit() on average, wherever one looks.
    std::optional<PhotonEmission> emit_caustic(Sequence &sequence) const { return emit(by_use_, casters_, sequence); }

  private:
    // Lamps, then emissive triangles, then the world.
    size_t world_source() const { return by_power_.size() - 1; }
    std::optional<PhotonEmission> emit(const Choices &choices, std::span<const Caster> casters,
                                       Sequence &sequence) const;
    PhotonEmission emit_from_triangle(const EmissiveTriangles::Emitter &emitter, std::span<const Caster> casters,
                                      const EmissionNumbers &u) const;
    PhotonEmission emit_from_world(std::span<const Caster> casters, const EmissionNumbers &u) const;
    float wanted_share(size_t source) const;

    const Scene &scene_;
    const Lights &lights_;
    SceneSphere sphere_;
    std::vector<Caster> casters_;
    Choices by_power_;
    Choices by_use_;
};

}  // namespace photon_maps
