// SPDX-License-Identifier: GPL-3.0-or-later
#include "kernel_area.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace photon_maps {

namespace {

/// A vector in the tangent plane, in radii.
template <typename T>
struct Point2 {
    T x, y;
};

template <typename T>
T cross(Point2<T> a, Point2<T> b) {
    return a.x * b.y - a.y * b.x;
}
template <typename T>
T dot(Point2<T> a, Point2<T> b) {
    return a.x * b.x + a.y * b.y;
}
template <typename T>
Point2<T> operator+(Point2<T> a, Point2<T> b) {
    return {a.x + b.x, a.y + b.y};
}
template <typename T>
Point2<T> operator-(Point2<T> a, Point2<T> b) {
    return {a.x - b.x, a.y - b.y};
}
template <typename T>
Point2<T> operator*(Point2<T> a, T s) {
    return {a.x * s, a.y * s};
}
template <typename T>
Point2<T> normalize(Point2<T> a) {
    return a * (1 / std::sqrt(dot(a, a)));
}

/// A point or vector of space relative to a kernel's centre, exactly: an edge may be longer than a radius by far.
struct Precise3 {
    double x, y, z;
};
Precise3 exact_difference(Vec3 a, Vec3 b) { return {double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z}; }
double dot(Precise3 a, Precise3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double dot(Precise3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns whether an edge from a to b, relative to the kernel's centre, comes near it in its plane.
/// @param highest distance from the plane
bool bounds_surface(Precise3 a, Precise3 b, Vec3 normal, double radius, double highest) {
    // Most edges lie wholly above or below what counts.
    const double height_a = dot(a, normal), height_b = dot(b, normal);
    if (std::min(height_a, height_b) >= highest || std::max(height_a, height_b) <= -highest) return false;
    const Precise3 ab{b.x - a.x, b.y - a.y, b.z - a.z};
    const double squared = dot(ab, ab);
    const double s = squared > 0 ? std::clamp(-dot(a, ab) / squared, 0.0, 1.0) : 0.0;
    const Precise3 closest{a.x + s * ab.x, a.y + s * ab.y, a.z + s * ab.z};
    return dot(closest, closest) < radius * radius && std::abs(height_a + s * (height_b - height_a)) < highest;
}

/// Returns whether an edge is the foot of a sheet that stands on a plane, on the side of its normal. What is no sheet
/// has a face that lies there, whose edge it is.
bool is_foot(const FeatureEdge &edge, Vec3 normal) {
    return edge.is_open && dot(normalize(edge.inward()), normal) > normal_tolerance;
}

/// Returns whether a barrier lies along another one from end to end: surfaces that meet each have an edge there.
bool is_along(const Barrier &barrier, const Barrier &other) {
    constexpr float near = 1e-4f;
    const Point2<float> a{other.ax, other.ay}, b{other.bx, other.by};
    const float length = std::sqrt(dot(b - a, b - a));
    const Point2<float> along = (b - a) * (1 / length);
    const auto is_on = [&](Point2<float> p) {
        const float way = dot(p - a, along);
        return std::abs(cross(along, p - a)) < near && way > -near && way < length + near;
    };
    return is_on({barrier.ax, barrier.ay}) && is_on({barrier.bx, barrier.by});
}

/// Clips the line from a to b to the unit disc and adds what is left as a barrier.
/// @param tolerance distance below which rounding decides on which side of the line the centre lies
void add_barrier(Point2<double> a, Point2<double> b, double tolerance, KernelRegion::Barriers &barriers) {
    const double length = std::sqrt(dot(b - a, b - a));
    if (!(length > 0)) return;
    Point2<double> along = (b - a) * (1 / length);
    double distance = cross(a, along);
    double from = dot(a, along), to = from + length;
    if (std::abs(distance) < tolerance) {
        // The centre is on the edge, so its surface lies to the left, whether the edge is its own or that of something
        // standing on it. The ends give way too, lest the disc shows between the edges of a corner.
        distance = tolerance;
        from -= 8 * tolerance;
        to += 8 * tolerance;
    } else if (distance < 0) {
        along = along * -1.0;
        distance = -distance;
        from = -std::exchange(to, -from);
    }
    if (distance >= 1) return;
    const double reach = std::sqrt(1 - distance * distance);
    from = std::max(from, -reach);
    to = std::min(to, reach);
    // Nothing is left, or next to nothing, of which single precision would not keep the direction.
    if (!(to - from > 1e-6 * (distance + std::max(std::abs(from), std::abs(to))))) return;
    const Point2<double> foot{along.y * distance, -along.x * distance};
    const Point2<double> start = foot + along * from, end = foot + along * to;
    barriers.emplace_back() = {static_cast<float>(start.x), static_cast<float>(start.y), static_cast<float>(end.x),
                               static_cast<float>(end.y)};
}

/// A barrier's line: all points whose product with `inverse` is 1.
struct Line {
    Point2<float> a, b;     ///< ends, counter-clockwise
    Point2<float> along;    ///< unit vector from a to b
    float distance;         ///< from the centre
    Point2<float> inverse;  ///< unit vector to the foot of the perpendicular, over the distance

    explicit Line(const Barrier &barrier)
        : a{barrier.ax, barrier.ay},
          b{barrier.bx, barrier.by},
          along(normalize(b - a)),
          distance(cross(a, along)),
          inverse(Point2<float>{along.y, -along.x} * (1 / distance)) {}

    /// Returns where the ray in a direction meets the line.
    Point2<float> meet(Point2<float> direction) const { return direction * (1 / dot(inverse, direction)); }
};

/// Returns the integral of Kernel::wedge(s) over the angle from the foot of the perpendicular (length h) to a point x
/// along the line, s being the distance of the line at that angle; both in radii. With s = h / cos and x = h tan:
///   integral of s^2 = h x,   of s^4 = h^3 x + h x^3 / 3,   of s^3 = (h x s + h^3 asinh(x / h)) / 2,
///   and by parts, of s^(2m) = (h x s^(2m - 2) + (2m - 2) h^2 (that of s^(2m - 2))) / (2m - 1).
float wedge_integral(float h, float x, const Kernel &kernel) {
    const float s2 = h * h + x * x;
    switch (kernel.filter) {
        case PM_FILTER_NONE:
            return h * x / 2;
        case PM_FILTER_CONE:
            return h * x / 2 - (h * x * std::sqrt(s2) + h * h * h * std::asinh(x / h)) / (6 * kernel.cone_k);
        case PM_FILTER_GAUSSIAN: {
            // The wedge is alpha (s^2 / 2 + c / beta (1 - exp(-u) - u)) with u = beta s^2 / 2, as a series in s^2.
            constexpr auto alpha = static_cast<float>(gaussian_alpha), beta = static_cast<float>(gaussian_beta);
            constexpr auto c = static_cast<float>(gaussian_c);
            float term = h * x, coefficient = beta / 2, power = 1, series = 0;
            for (int m = 2; m <= 11; ++m) {
                const auto n = static_cast<float>(m);
                power *= s2;
                term = (h * x * power + (2 * n - 2) * h * h * term) / (2 * n - 1);
                coefficient *= -beta / (2 * n);
                series += coefficient * term;
            }
            return alpha * (h * x / 2 + c / beta * series);
        }
        case PM_FILTER_EPANECHNIKOV:
            return h * x / 2 - (h * h * h * x + h * x * x * x / 3) / 4;
    }
    return 0;
}

/// Returns the part of the kernel's integral that lies beyond a line, between two points on it.
float lost_beyond(const Line &line, Point2<float> from, Point2<float> to, float full_wedge, const Kernel &kernel) {
    const float angle = std::atan2(cross(from, to), dot(from, to));
    return full_wedge * angle - (wedge_integral(line.distance, dot(to, line.along), kernel) -
                                 wedge_integral(line.distance, dot(from, line.along), kernel));
}

/// Returns the line that is met first in a direction.
const Line *nearest(std::span<const Line *const> lines, Point2<float> direction) {
    return *std::ranges::max_element(lines, {}, [&](const Line *line) { return dot(line->inverse, direction); });
}

/// Returns what is lost between two directions, both of which meet all the lines. The line met first at either end is
/// met first all the way if it is the same: two lines cross once. Else they cross between, and the parts are simpler.
float lost_between(std::span<const Line *const> lines, Point2<float> from, Point2<float> to, float full_wedge,
                   const Kernel &kernel) {
    const Line *first = nearest(lines, from), *last = nearest(lines, to);
    if (first != last) {
        constexpr float rounding = 1e-6f;
        const Point2<float> difference = first->inverse - last->inverse;
        Point2<float> crossing = normalize(Point2<float>{difference.y, -difference.x});
        if (dot(crossing, from + to) < 0) crossing = crossing * -1.0f;
        if (cross(from, crossing) > rounding && cross(crossing, to) > rounding) {
            return lost_between(lines, from, crossing, full_wedge, kernel) +
                   lost_between(lines, crossing, to, full_wedge, kernel);
        }
        if (cross(from, crossing) <= rounding) first = last;
    }
    return lost_beyond(*first, first->meet(from), first->meet(to), full_wedge, kernel);
}

/// Returns whether the angles under which two lines are seen have more than an end in common.
bool overlap(const Line &p, const Line &q) {
    constexpr float rounding = 1e-6f;
    const auto starts_within = [](const Line &inner, const Line &outer) {
        return cross(outer.a, inner.a) >= -rounding * std::abs(dot(outer.a, inner.a)) &&
               cross(inner.a, outer.b) > rounding * std::abs(dot(inner.a, outer.b));
    };
    return starts_within(p, q) || starts_within(q, p);
}

/// Returns what two barriers take of the kernel's integral if none stands before the other, as in a corner.
std::optional<float> lost_to_pair(std::span<const Barrier> barriers, float full_wedge, const Kernel &kernel) {
    const Line p(barriers[0]), q(barriers[1]);
    if (overlap(p, q)) return std::nullopt;
    return lost_beyond(p, p.a, p.b, full_wedge, kernel) + lost_beyond(q, q.a, q.b, full_wedge, kernel);
}

/// Returns what several barriers take of the kernel's integral: the circle is split at all their ends, and between two
/// ends the nearest barrier bounds what is seen.
float lost_to_all(std::span<const Barrier> barriers, float full_wedge, const Kernel &kernel) {
    const std::vector<Line> lines(barriers.begin(), barriers.end());
    std::vector<Point2<float>> ends;
    for (const Line &line : lines) {
        ends.push_back(normalize(line.a));
        ends.push_back(normalize(line.b));
    }
    const auto turn = [](Point2<float> d) { return std::copysign(1 - d.x, d.y); };  // grows as the angle does
    std::ranges::sort(ends, {}, turn);

    float lost = 0;
    std::vector<const Line *> active;
    for (size_t i = 0; i < ends.size(); ++i) {
        const Point2<float> from = ends[i], to = ends[(i + 1) % ends.size()];
        if (!(cross(from, to) > 0)) continue;  // nothing, or a half circle and more, which no barrier spans
        const Point2<float> middle = from + to;
        active.clear();
        for (const Line &line : lines) {
            if (cross(line.a, middle) > 0 && cross(middle, line.b) > 0) active.push_back(&line);
        }
        if (!active.empty()) lost += lost_between(active, from, to, full_wedge, kernel);
    }
    return lost;
}

}  // namespace

KernelRegion::KernelRegion(const EdgeIndex &edges, Vec3 p, Vec3 normal, const Kernel &kernel) {
    if (!(kernel.radius <= edges.max_radius())) {
        throw std::invalid_argument("the kernel is larger than the index of edges was built for");
    }
    const std::span<const uint32_t> candidates = edges.lookup(p);
    if (candidates.empty()) return;
    const double radius = kernel.radius;
    // Rounding of p, and of the ray that found it, is proportional to its coordinates.
    const double tolerance = std::min(1e-6 + 4e-7 * max_component(abs(p)) / radius, 0.01);
    const Frame frame(normal);
    const auto project = [&](Precise3 q) { return Point2<double>{dot(q, frame.x) / radius, dot(q, frame.y) / radius}; };
    const auto reaches = [&](const FeatureEdge &edge, double highest) {
        return bounds_surface(exact_difference(edge.a, p), exact_difference(edge.b, p), normal, radius, highest);
    };
    const auto add = [&](const FeatureEdge &edge) {
        add_barrier(project(exact_difference(edge.a, p)), project(exact_difference(edge.b, p)), tolerance, barriers_);
    };

    // Edges of what lies in the plane.
    std::array<uint32_t, max_barriers> feet;
    size_t foot_count = 0;
    for (const uint32_t candidate : candidates) {
        const FeatureEdge &edge = edges.edge(candidate);
        constexpr double standing_tolerance = 0.01;
        if (std::abs(dot(edge.normal, normal)) > normal_tolerance) {
            if (reaches(edge, plane_tolerance * radius)) add(edge);
        } else if (edge.is_open && reaches(edge, standing_tolerance * radius) && is_foot(edge, normal)) {
            if (foot_count < feet.size()) feet[foot_count++] = candidate;
        }
        if (barriers_.size() > max_barriers) break;
    }

    // Feet of sheets that stand on it: light does not pass beneath.
    for (size_t f = 0; f < foot_count && barriers_.size() <= max_barriers; ++f) {
        const size_t before = barriers_.size();
        add(edges.edge(feet[f]));
        if (barriers_.size() == before) continue;
        const std::span<const Barrier> others = barriers().first(before);
        if (std::ranges::any_of(others, [&](const Barrier &other) { return is_along(barriers_[before], other); }))
            barriers_.pop_back();
    }
    is_crowded_ = barriers_.size() > max_barriers;
    if (is_crowded_)
        barriers_.clear();
    else
        measure(kernel);
}

KernelRegion::KernelRegion(std::span<const Barrier> barriers, const Kernel &kernel) {
    for (const Barrier &barrier : barriers) {
        add_barrier({barrier.ax, barrier.ay}, {barrier.bx, barrier.by}, 1e-6, barriers_);
    }
    measure(kernel);
}

void KernelRegion::measure(const Kernel &kernel) {
    if (barriers_.empty()) return;
    const Kernel unit{kernel.filter, 1, kernel.cone_k};
    const float full_wedge = unit.wedge(1);
    std::optional<float> lost;
    if (barriers_.size() == 1) {
        const Line line(barriers()[0]);
        lost = lost_beyond(line, line.a, line.b, full_wedge, unit);
    } else if (barriers_.size() == 2) {
        lost = lost_to_pair(barriers(), full_wedge, unit);
    }
    if (!lost) lost = lost_to_all(barriers(), full_wedge, unit);
    share_ = 1 - *lost / (2 * pi * full_wedge);

    // A centre walled in on all sides lies on the seam of faces that meet without being joined: no surface ends there.
    constexpr float smallest_share = 1e-4f;
    if (share_ < smallest_share) {
        barriers_.clear();
        share_ = 1;
    }
}

}  // namespace photon_maps
