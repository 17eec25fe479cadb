// SPDX-License-Identifier: GPL-3.0-or-later
#include "direction_map.h"

#include "sampling.h"

namespace photon_maps {

namespace {

// Cells of longitude and latitude; a bright one has cells of its own. They are fine enough for the sun's disk.
constexpr uint32_t width = 512, height = 256, fine_size = 8;
/// Share of the whole from which on a coarse cell is bright.
constexpr double bright_share = 1.0 / 2048;

/// Share of the directions that is chosen uniformly: the map may have missed something.
constexpr float uniform_share = 0.05f;
constexpr float uniform_pdf = 1 / (4 * pi);

constexpr double pi_double = std::numbers::pi;

/// Direction at a longitude (x of the grid's width) and colatitude (y of its height).
Vec3 direction_at(double x, double y) {
    const double phi = 2 * pi_double * x / width - pi_double, theta = pi_double * y / height;
    return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
            static_cast<float>(std::cos(theta))};
}

/// Solid angle of a cell of a size in cells of the coarse grid, whose top is at y.
double solid_angle(double y, double size) {
    return 2 * pi_double / width * size * 2 * std::sin(pi_double * (y + size / 2) / height) *
           std::sin(pi_double * size / 2 / height);
}

/// A point of a cell, uniform by solid angle.
Vec3 direction_in(double x, double y, double size, float u, float v) {
    const double phi = 2 * pi_double * (x + size * static_cast<double>(u)) / width - pi_double;
    const double top = std::cos(pi_double * y / height), bottom = std::cos(pi_double * (y + size) / height);
    const double z = top + (bottom - top) * static_cast<double>(v);
    const double sine = std::sqrt(std::max(0.0, 1 - z * z));
    return {static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)), static_cast<float>(z)};
}

/// A function on the corners, sides and middles of the cells of a grid: neighbours share points, so that what lies
/// across a side counts for both.
struct CellValues {
    std::vector<float> weights;  // the largest value of each cell, times its solid angle
    std::vector<double> means;   // of each cell
    double mean = 0;             // of all, by solid angle
};

CellValues look_at_cells(double x0, double y0, double size, uint32_t columns, uint32_t rows,
                         const std::function<float(Vec3)> &value) {
    const uint32_t stride = 2 * columns + 1;
    std::vector<float> points;
    points.reserve(size_t{stride} * (2 * rows + 1));
    for (uint32_t j = 0; j <= 2 * rows; ++j)
        for (uint32_t i = 0; i < stride; ++i)
            points.push_back(value(direction_at(x0 + i * size / 2, y0 + j * size / 2)));

    CellValues cells;
    double weighted = 0, total = 0;
    for (uint32_t y = 0; y < rows; ++y) {
        const double cell_angle = solid_angle(y0 + y * size, size);
        for (uint32_t x = 0; x < columns; ++x) {
            float largest = 0, sum = 0;
            for (uint32_t k = 0; k < 9; ++k) {
                const float point = points[(2 * y + k / 3) * size_t{stride} + 2 * x + k % 3];
                largest = std::max(largest, point);
                sum += point * static_cast<float>((k % 3 == 1 ? 2 : 1) * (k / 3 == 1 ? 2 : 1));  // trapezoids
            }
            cells.weights.push_back(largest * static_cast<float>(cell_angle));
            cells.means.push_back(static_cast<double>(sum) / 16);
            weighted += cells.means.back() * cell_angle;
            total += cell_angle;
        }
    }
    cells.mean = weighted / total;
    return cells;
}

/// A direction's place among the coarse cells.
struct CellPosition {
    double x, y;  // in cells of the coarse grid
    uint32_t column, row;

    explicit CellPosition(Vec3 d) {
        const auto dx = static_cast<double>(d.x), dy = static_cast<double>(d.y), dz = static_cast<double>(d.z);
        x = (std::atan2(dy, dx) / (2 * pi_double) + 0.5) * width;
        y = std::atan2(std::sqrt(dx * dx + dy * dy), dz) / pi_double * height;
        column = std::min(static_cast<uint32_t>(x), width - 1);
        row = std::min(static_cast<uint32_t>(y), height - 1);
    }
};

}  // namespace

DirectionMap::DirectionMap(const std::function<float(Vec3)> &value) {
    // Look at all directions.
    const CellValues coarse = look_at_cells(0, 0, 1, width, height, value);
    mean_ = static_cast<float>(coarse.mean);
    std::vector<float> weights = coarse.weights;
    double total = 0;
    for (const float weight : weights) total += static_cast<double>(weight);
    if (!(total > 0)) return;

    // Look closer where it is bright.
    fine_index_.resize(weights.size());
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            const size_t cell = size_t{y} * width + x;
            if (static_cast<double>(weights[cell]) < bright_share * total) continue;
            const CellValues fine = look_at_cells(x, y, 1.0 / fine_size, fine_size, fine_size, value);
            double sum = 0;
            for (const float weight : fine.weights) sum += static_cast<double>(weight);
            if (!(sum > 0)) continue;
            const double cell_angle = solid_angle(y, 1);
            mean_ += static_cast<float>((fine.mean - coarse.means[cell]) * cell_angle / (4 * pi_double));
            weights[cell] = static_cast<float>(sum);
            fine_.emplace_back(fine_size, fine_size, fine.weights);
            fine_index_[cell] = static_cast<uint32_t>(fine_.size());
        }
    }
    coarse_ = GridDistribution(width, height, weights);
}

Vec3 DirectionMap::sample(float u, float v) const {
    if (empty()) return Frame({0, 0, 1}).to_world(sample_cone(u, v, 2));
    if (v < uniform_share) return Frame({0, 0, 1}).to_world(sample_cone(u, v / uniform_share, 2));
    GridDistribution::Cell cell = coarse_.sample(u, (v - uniform_share) / (1 - uniform_share));
    double x = cell.x, y = cell.y, size = 1;
    if (const uint32_t fine = fine_index_[size_t{cell.y} * width + cell.x]) {
        cell = fine_[fine - 1].sample(cell.u, cell.v);
        size = 1.0 / fine_size;
        x += cell.x * size;
        y += cell.y * size;
    }
    return direction_in(x, y, size, cell.u, cell.v);
}

float DirectionMap::pdf(Vec3 direction) const {
    if (empty()) return uniform_pdf;
    const CellPosition at(direction);
    float probability = coarse_.probability(at.column, at.row);
    double y = at.row, size = 1;
    if (const uint32_t fine = fine_index_[size_t{at.row} * width + at.column]) {
        const auto i = std::min(static_cast<uint32_t>((at.x - at.column) * fine_size), fine_size - 1);
        const auto j = std::min(static_cast<uint32_t>((at.y - at.row) * fine_size), fine_size - 1);
        probability *= fine_[fine - 1].probability(i, j);
        size = 1.0 / fine_size;
        y += j * size;
    }
    return uniform_share * uniform_pdf + (1 - uniform_share) * probability / static_cast<float>(solid_angle(y, size));
}

}  // namespace photon_maps
