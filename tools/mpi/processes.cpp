// SPDX-License-Identifier: MIT
#include "mpi/processes.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <thread>

#include <dlfcn.h>
#include <sched.h>

#include <taut/impl/core/compute/program/private_folder.hpp>
#include <taut/impl/dist/shape/own_queue.hpp>

#include "shared/own_kernels.hpp"

namespace taut::tools::mpi
{

namespace
{

std::string variable(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

void propose(const char* name, const std::string& value)
{
    if (variable(name).empty()) ::setenv(name, value.c_str(), 1);
}

/// Cores of a process: those that it is bound to, or its share of the machine.
int cores(int processes)
{
    const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    cpu_set_t set;
    CPU_ZERO(&set);
    const int bound = ::sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : machine;
    return bound < machine ? bound : std::max(1, machine / processes);
}

} // namespace

void share_machine(const dist::impl::communicator& all)
{
    namespace fs = std::filesystem;
    const auto here = dist::impl::rank_on_machine(all);
    const std::string threads = std::to_string(cores(here.size));
    propose("TAUT_THREADS", threads);
    propose("POCL_MAX_PTHREAD_COUNT", threads);
    if (variable("OMP_NUM_THREADS").empty()) // its runtime has looked already
        if (void* const set = ::dlsym(RTLD_DEFAULT, "omp_set_num_threads")) reinterpret_cast<void (*)(int)>(set)(1);

    fs::path caches = variable("POCL_CACHE_DIR");
    if (caches.empty())
    {
        fs::path base = variable("XDG_CACHE_HOME");
        if (base.empty() && !variable("HOME").empty()) base = fs::path(variable("HOME")) / ".cache";
        if (base.empty()) return; // own_queue() refuses what PoCL takes then
        caches = base / "taut-mpi";
    }
    caches /= "process-" + std::to_string(here.rank);
    impl::fault_of_made_folder(caches); // of which own_queue() tells, if it is PoCL that is used
    ::setenv("POCL_CACHE_DIR", caches.c_str(), 1);
}

queue own_queue(const dist::impl::communicator& all, const std::string& device)
{
    const auto here = dist::impl::rank_on_machine(all);
    std::optional<queue> q;
    all.together(
        [&]
        {
            q = device.empty() ? dist::impl::open_own_queue(here) : queue(find_device(device, {}, "--device "));
            require_own_kernels(q->device());
        });
    return *q;
}

} // namespace taut::tools::mpi
