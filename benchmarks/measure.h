// SPDX-License-Identifier: GPL-3.0-or-later
// Time taken by pieces of work that run by turns in one process, so that the machine's other load falls on all alike.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <string>
#include <thread>
#include <vector>

namespace bench {

/// What a piece of work took in each round.
struct Times {
    std::vector<double> cpu;   ///< s, all threads of the process together
    std::vector<double> wall;  ///< s
};

inline double seconds_on(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Runs each piece of work once a round, one after the other.
inline std::vector<Times> run_by_turns(int rounds, std::initializer_list<std::function<void()>> works) {
    std::vector<Times> times(works.size());
    for (int round = 0; round < rounds; ++round) {
        auto time = times.begin();
        for (const auto &work : works) {
            const double cpu = seconds_on(CLOCK_PROCESS_CPUTIME_ID), wall = seconds_on(CLOCK_MONOTONIC);
            work();
            time->cpu.push_back(seconds_on(CLOCK_PROCESS_CPUTIME_ID) - cpu);
            time->wall.push_back(seconds_on(CLOCK_MONOTONIC) - wall);
            ++time;
        }
    }
    return times;
}

/// A quantity over the rounds.
struct Statistic {
    double median, least, greatest;

    explicit Statistic(std::vector<double> values) {
        std::ranges::sort(values);
        const size_t n = values.size();
        median = (values[n / 2] + values[(n - 1) / 2]) / 2;
        least = values.front();
        greatest = values.back();
    }
    /// "median (least to greatest)"
    std::string text(int decimals) const {
        char buffer[96];
        std::snprintf(buffer, sizeof buffer, "%.*f (%.*f to %.*f)", decimals, median, decimals, least, decimals,
                      greatest);
        return buffer;
    }
};

/// Work per second in each round.
inline Statistic rate(double work, std::vector<double> seconds) {
    for (double &s : seconds) s = work / s;
    return Statistic(std::move(seconds));
}

/// Quotients within the rounds: neighbours in time share the machine's mood.
inline Statistic ratio(std::vector<double> dividends, const std::vector<double> &divisors) {
    for (size_t i = 0; i < dividends.size(); ++i) dividends[i] /= divisors[i];
    return Statistic(std::move(dividends));
}

/// A row of the table that parts_bench.py gathers from all programs: it knows what is wanted of each by its name.
inline void print_row(const std::string &name, const Statistic &ratio) {
    std::printf("row: %s = %.4g %.4g %.4g\n", name.c_str(), ratio.median, ratio.least, ratio.greatest);
}

/// Returns how many rounds the command line asks for.
inline int rounds_asked(int argc, char **argv) { return argc > 1 ? std::max(1, std::atoi(argv[1])) : 5; }

/// Says what else the machine is doing: absolute figures of a busy one mean little, ratios still do.
inline void print_machine() {
    double load[3] = {};
    if (getloadavg(load, 3) < 1) load[0] = -1;
    std::printf("%u cores, load of the last minute %.2f; medians, and in brackets the least and greatest round\n",
                std::thread::hardware_concurrency(), load[0]);
}

/// Ends the program unless both sides of a comparison did the same work.
inline void require(bool condition, const std::string &what) {
    if (condition) return;
    std::fflush(stdout);
    std::fprintf(stderr, "benchmark not valid: %s\n", what.c_str());
    std::exit(1);
}

}  // namespace bench
