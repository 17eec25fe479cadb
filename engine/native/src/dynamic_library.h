// SPDX-License-Identifier: GPL-3.0-or-later
// A library loaded by its full path, on each system so that it binds to itself and not to what the process has loaded.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace photon_maps {

/// A library cannot be loaded, or lacks a function.
struct LibraryError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A loaded library; on Windows freed with this.
class DynamicLibrary {
  public:
    /// @param path in UTF-8
    /// @throws LibraryError with the system's own reason
    explicit DynamicLibrary(const std::string &path);

    /// Sets a pointer to the function of that name.
    /// @throws LibraryError if there is none
    template <typename Function>
    void resolve(const char *name, Function *&function) const {
        function = reinterpret_cast<Function *>(find(name));
        if (!function) throw LibraryError(std::string("it has no function ") + name);
    }

  private:
    struct Closer {
        void operator()(void *handle) const;
    };
    using Address = void (*)();

    /// Returns null if there is no function of that name.
    Address find(const char *name) const;

    std::unique_ptr<void, Closer> handle_;
};

}  // namespace photon_maps
