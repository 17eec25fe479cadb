// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over threads: every index once, exceptions brought home, cancel heeded.
#include <string>
#include <vector>

#include "check.h"
#include "parallel.h"

using namespace photon_maps;
using photon_maps::test::Checks;

namespace {

void test_every_index_is_visited_once(Checks &checks) {
    for (const int threads : {1, 2, 5}) {
        for (const size_t count : {size_t{0}, size_t{1}, size_t{3}, size_t{10000}}) {
            std::vector<std::atomic<int>> visits(count);
            parallel_for(threads, count, nullptr, [&](size_t i) { ++visits[i]; });
            for (const auto &number : visits) checks.that(number == 1, "visited once");
        }
    }
    checks.that(thread_count(3) == 3 && thread_count(0) >= 1, "a number of threads");
}

void test_an_exception_ends_the_loop(Checks &checks) {
    for (const int threads : {1, 4}) {
        std::atomic<int> visits = 0;
        std::string caught;
        try {
            parallel_for(threads, 1'000'000, nullptr, [&](size_t i) {
                ++visits;
                if (i == 10) throw std::runtime_error("ten");
            });
        } catch (const std::runtime_error &error) {
            caught = error.what();
        }
        checks.that(caught == "ten", "the exception arrives");
        checks.that(visits < 1'000'000, "the rest is left out");
    }
}

void test_cancel_ends_the_loop(Checks &checks) {
    for (const int threads : {1, 4}) {
        std::atomic<bool> cancel = false;
        std::atomic<int> visits = 0;
        bool cancelled = false;
        try {
            parallel_for(threads, 1'000'000, &cancel, [&](size_t) {
                if (++visits == 100) cancel = true;
            });
        } catch (const Cancelled &) {
            cancelled = true;
        }
        checks.that(cancelled, "it says that it was cancelled");
        checks.that(visits < 1'000'000, "the rest is left out");
    }
}

}  // namespace

int main() {
    Checks checks;
    test_every_index_is_visited_once(checks);
    test_an_exception_ends_the_loop(checks);
    test_cancel_ends_the_loop(checks);
    return checks.report();
}
