// SPDX-License-Identifier: MIT
#pragma once

#ifdef _WIN32
#ifndef NOMINMAX
#define NOMINMAX
#endif
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <utility>

#include <taut/device.hpp>
#include <taut/impl/core/compute/opencl/library.hpp>

namespace taut::impl
{

/// Opens the loader of OpenCL's drivers; null where there is none.
inline void* open_opencl_library()
{
#ifdef _WIN32
    return reinterpret_cast<void*>(::LoadLibraryA("OpenCL.dll"));
#else
    // For all to see, as if the program were linked with it: libraries that watch its calls look there.
    for (const char* name :
#ifdef __APPLE__
         {"/System/Library/Frameworks/OpenCL.framework/OpenCL", "libOpenCL.dylib"}
#else
         {"libOpenCL.so.1", "libOpenCL.so"}
#endif
    )
        if (void* const library = ::dlopen(name, RTLD_NOW | RTLD_GLOBAL)) return library;
    return nullptr;
#endif
}

/// A function of it; what is already in the process under this name goes first.
inline void* opencl_function(void* library, const char* name)
{
#ifdef _WIN32
    return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
#else
    void* const there = ::dlsym(RTLD_DEFAULT, name);
    return there || !library ? there : ::dlsym(library, name);
#endif
}

const opencl_library* opencl_library::find()
{
    static const auto found = []
    {
        void* const library = open_opencl_library();
        std::pair<opencl_library, bool> all{{}, true};
#define TAUT_OPENCL_FIND(name)                                                                                         \
    all.first.name = reinterpret_cast<decltype(&::name)>(opencl_function(library, #name));                             \
    all.second = all.second && all.first.name;
        TAUT_OPENCL_FUNCTIONS(TAUT_OPENCL_FIND)
#undef TAUT_OPENCL_FIND
        return all;
    }();
    return found.second ? &found.first : nullptr;
}

const opencl_library& opencl_library::get()
{
    const opencl_library* const found = find();
    if (!found)
        throw device_error("calling OpenCL", "its library is not installed (libOpenCL.so.1 of ocl-icd or a driver)",
                           "none");
    return *found;
}

} // namespace taut::impl
