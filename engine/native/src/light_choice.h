// SPDX-License-Identifier: GPL-3.0-or-later
// The choice of one source of light among many by what it might bring to a point: of few exactly, of many by a tree
// whose far nodes stand for all that they hold (Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting"), so that the work grows by the logarithm of their number.
#pragma once

#include <optional>

#include "eights.h"
#include "fixed_vector.h"

namespace photon_maps {

/// Share of choices among lights that does not ask how strong they are: a dim lamp may be all that lights a room beside
/// which another one is bright, and what is hardly ever chosen is noise that no picture gets rid of.
constexpr float even_share = 0.05f;

/// The irradiance that a source might bring to a surface, W/m2: constant + factor / max(squared distance, floor).
struct LightReach {
    Vec3 position;
    float factor = 0, floor = 1, constant = 0;

    bool is_dark() const { return !(factor + constant > 0); }
};

/// Light sources to choose from.
class LightChoice {
  public:
    /// @param sources those that are dark are never chosen
    explicit LightChoice(std::span<const LightReach> sources);

    /// A source chosen by chance.
    struct Choice {
        size_t source;
        float probability;
        float left;  ///< what is left of the random number, uniform in [0, 1) again
    };

    /// A node, some of whose children may be opened: they are nodes of the chances on their own.
    struct Node {
        NodePlace place;
        std::array<bool, lanes> opened;
        Eight importances;  ///< of the children that are not opened, else 0
        float importance;   ///< of all these
        uint32_t sources;   ///< number of them
    };

    /// What all sources might bring to a point.
    struct Chances {
        Vec3 position;
        FixedVector<Node, 64> nodes;
        float total = 0;  ///< of importance and even shares
        float each = 0;   ///< what each source has besides its importance
    };
    Chances at(Vec3 position) const;

    /// Chooses a source; nothing where none brings anything.
    std::optional<Choice> choose(const Chances &chances, float u) const;

    /// Probability with which choose() takes a source.
    float probability(const Chances &chances, size_t source) const;

  private:
    /// Eight children, each as if it were one source.
    struct Reaches {
        Eight x{}, y{}, z{}, factor{}, floor{1, 1, 1, 1, 1, 1, 1, 1}, constant{};

        void set(size_t lane, const LightReach &reach);
        Float8 squared_distances(Vec3 position) const;
        Float8 importances(Float8 squared_distances) const;
    };

    void open_near(Chances &chances) const;
    void weigh(Chances &chances, size_t node) const;
    uint32_t sources_below(uint32_t level, uint32_t child) const;
    Eight shared(float importance, NodePlace place, Vec3 position) const;

    std::vector<uint32_t> sources_;             // in order of the tree
    std::vector<uint32_t> places_;              // of each source in that order, or none
    std::vector<std::vector<Reaches>> levels_;  // from the sources up
};

}  // namespace photon_maps
