// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamic_library.h"

#if defined(_WIN32)
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <system_error>

namespace photon_maps {

#if defined(_WIN32)

namespace {

std::wstring wide(const std::string &utf8) {
    const int size = static_cast<int>(utf8.size());
    std::wstring result(static_cast<size_t>(MultiByteToWideChar(CP_UTF8, 0, utf8.data(), size, nullptr, 0)), L'\0');
    MultiByteToWideChar(CP_UTF8, 0, utf8.data(), size, result.data(), static_cast<int>(result.size()));
    return result;
}

}  // namespace

// The libraries beside it come before those of the process's own folder.
DynamicLibrary::DynamicLibrary(const std::string &path)
    : handle_(LoadLibraryExW(wide(path).c_str(), nullptr, LOAD_WITH_ALTERED_SEARCH_PATH)) {
    if (!handle_) throw LibraryError(std::system_category().message(static_cast<int>(GetLastError())));
}

void DynamicLibrary::Closer::operator()(void *handle) const { FreeLibrary(static_cast<HMODULE>(handle)); }

DynamicLibrary::Address DynamicLibrary::find(const char *name) const {
    return reinterpret_cast<Address>(GetProcAddress(static_cast<HMODULE>(handle_.get()), name));
}

#else

namespace {

// Blender's executable puts its own Embree and TBB into the global scope; without RTLD_DEEPBIND a library would bind to
// them. The sanitizers' runtimes refuse that flag, and run in no process with a second Embree. macOS has no
// such flag: there a library names those that it binds to. It stays loaded, for threads that were in it may end later,
// and then call what it registered; files in use can be replaced here.
#if defined(RTLD_DEEPBIND) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr int load_flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE | RTLD_DEEPBIND;
#else
constexpr int load_flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;
#endif

}  // namespace

DynamicLibrary::DynamicLibrary(const std::string &path) : handle_(dlopen(path.c_str(), load_flags)) {
    if (handle_) return;
    const char *reason = dlerror();
    throw LibraryError(reason ? reason : path);
}

void DynamicLibrary::Closer::operator()(void *handle) const { dlclose(handle); }

DynamicLibrary::Address DynamicLibrary::find(const char *name) const {
    return reinterpret_cast<Address>(dlsym(handle_.get(), name));
}

#endif

}  // namespace photon_maps
