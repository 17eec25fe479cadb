// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a grid, chosen by weight (Pharr, Jakob, Humphreys 2023, appendix A.5.2: piecewise-constant 2D
// distributions).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vec.h"

namespace photon_maps {

class GridDistribution {
  public:
    struct Cell {
        uint32_t x, y;
        float u, v;  ///< what is left of the random numbers, uniform in [0, 1) again
    };

    GridDistribution() = default;
    /// @param weights width x height, not negative, by rows; one at least above 0
    GridDistribution(uint32_t width, uint32_t height, std::span<const float> weights) : width_(width) {
        std::vector<double> row_sums;
        for (uint32_t y = 0; y < height; ++y)
            row_sums.push_back(append_cumulative(weights.subspan(size_t{y} * width, width), columns_));
        append_cumulative(std::span<const double>(row_sums), rows_);
    }

    bool empty() const { return width_ == 0; }

    Cell sample(float u, float v) const {
        const auto y = choose(rows_, v);
        const auto x = choose(row(y), u);
        return {x, y, u, v};
    }

    /// Probability with which sample() takes a cell.
    float probability(uint32_t x, uint32_t y) const { return share(rows_, y) * share(row(y), x); }

  private:
    /// Appends the running sums over their total, which is returned; a total of 0 leaves zeros.
    template <class T>
    static double append_cumulative(std::span<const T> weights, std::vector<float> &cumulative) {
        double total = 0, sum = 0;
        for (const T w : weights) total += static_cast<double>(w);
        for (const T w : weights) {
            sum += static_cast<double>(w);
            cumulative.push_back(total > 0 ? static_cast<float>(sum / total) : 0.0f);
        }
        return total;
    }

    static float share(std::span<const float> cumulative, uint32_t i) {
        return cumulative[i] - (i == 0 ? 0.0f : cumulative[i - 1]);
    }

    /// Chooses an entry of a share above 0; u becomes what is left of it.
    static uint32_t choose(std::span<const float> cumulative, float &u) {
        const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), u);
        const auto i = static_cast<uint32_t>(found - cumulative.begin());
        constexpr float below_one = 0x1.fffffep-1f;
        u = std::min((u - (i == 0 ? 0.0f : cumulative[i - 1])) / share(cumulative, i), below_one);
        return i;
    }

    std::span<const float> row(uint32_t y) const { return std::span(columns_).subspan(size_t{y} * width_, width_); }

    uint32_t width_ = 0;
    std::vector<float> rows_, columns_;  // cumulative shares of the rows, and within each row
};

}  // namespace photon_maps
