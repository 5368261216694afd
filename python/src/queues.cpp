// SPDX-License-Identifier: MIT
#include "queues.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <vector>

#include <unistd.h>

namespace taut::python
{

namespace
{

namespace nb = nanobind;

/// Queues that nobody has, by what was asked for.
struct idle_queues
{
    static constexpr std::size_t most = 4; ///< that are kept of a device

    std::mutex mutex;
    std::map<std::string, std::vector<std::unique_ptr<queue>>> by_device;
    pid_t process = ::getpid();
    bool closed = false;
};

/// Never destroyed: queues come back from threads that may outlive all else.
idle_queues& idle()
{
    static auto* pool = new idle_queues;
    return *pool;
}

std::string wish_of(const std::string& device)
{
    const char* wish = std::getenv("TAUT_DEVICE");
    return device.empty() && wish ? wish : device;
}

} // namespace

std::shared_ptr<queue> borrow_queue(const std::string& device)
{
    const std::string wish = wish_of(device);
    auto& pool = idle();
    if (pool.process != ::getpid())
        throw device_error("opening a queue",
                           "this process was made by fork() after its parent had used OpenCL, whose drivers do not "
                           "survive that; start workers by spawn: multiprocessing.get_context(\"spawn\")",
                           "not opened");
    std::unique_ptr<queue> found;
    {
        const std::lock_guard lock(pool.mutex);
        auto& list = pool.by_device[wish];
        if (!list.empty())
        {
            found = std::move(list.back());
            list.pop_back();
        }
    }
    if (!found) found = std::make_unique<queue>(wish.empty() ? find_device() : find_device(wish));
    return {found.release(), [wish](queue* q)
            {
                std::unique_ptr<queue> back(q);
                auto& pool = idle();
                const std::lock_guard lock(pool.mutex);
                auto& list = pool.by_device[wish];
                if (!pool.closed && list.size() < idle_queues::most && pool.process == ::getpid())
                    list.push_back(std::move(back));
            }};
}

void drop_queues()
{
    auto& pool = idle();
    const std::lock_guard lock(pool.mutex);
    pool.by_device.clear();
    pool.closed = true;
}

void add_devices(nb::module_& m)
{
    m.def("devices",
          []
          {
              nb::list all;
              for (const auto& [d, refused] : devices())
              {
                  nb::dict entry;
                  entry["name"] = nb::str(d.name().c_str());
                  entry["vendor"] = nb::str(d.vendor().c_str());
                  entry["platform"] = nb::str(d.platform().c_str());
                  entry["driver"] = nb::str(d.driver_version().c_str());
                  entry["kind"] = d.is_host() ? "host" : d.is_gpu() ? "GPU" : d.is_cpu() ? "CPU" : "accelerator";
                  entry["double_precision"] = d.has_fp64();
                  entry["compute_units"] = d.compute_units();
                  entry["memory"] = d.global_memory();
                  entry["refusal"] = nb::str(refused.c_str());
                  all.append(entry);
              }
              return all;
          });
    m.def("drop_queues", &drop_queues);
}

} // namespace taut::python
