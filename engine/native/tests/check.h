// SPDX-License-Identifier: GPL-3.0-or-later
// Checks for test executables: every failure is printed with its place, and the exit status counts.
#pragma once

#include <cmath>
#include <iostream>
#include <source_location>
#include <string_view>

namespace photon_maps::test {

/// Counts what failed in one executable; `return checks.report();` ends its main.
class Checks {
  public:
    using Place = std::source_location;

    /// Fails unless `holds`; `what` says what was expected.
    void that(bool holds, std::string_view what, Place place = Place::current()) {
        ++count_;
        if (holds) return;
        ++failures_;
        std::cerr << place.file_name() << ':' << place.line() << ": " << what << '\n';
    }

    /// Fails unless `value` lies within `tolerance` of `expected`.
    void near(double value, double expected, double tolerance, std::string_view what, Place place = Place::current()) {
        ++count_;
        if (std::abs(value - expected) <= tolerance) return;
        ++failures_;
        std::cerr << place.file_name() << ':' << place.line() << ": " << what << ": " << value << ", expected "
                  << expected << " +- " << tolerance << '\n';
    }

    /// Returns 0 if all checks held and there was at least one.
    int report() const {
        std::cerr << count_ << " checks, " << failures_ << " failed\n";
        return failures_ == 0 && count_ > 0 ? 0 : 1;
    }

  private:
    long count_ = 0, failures_ = 0;
};

}  // namespace photon_maps::test
