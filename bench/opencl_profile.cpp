// SPDX-License-Identifier: MIT
// Profiles any OpenCL program without touching it: a library to be preloaded, between the program and the loader.
//   OPENCL_PROFILE=FILE LD_PRELOAD=libtaut_opencl_profile.so PROGRAM...
// When the program ends FILE has, as JSON: seconds of each kernel on the device by the device's clock and launches, the
// bytes of the buffers that a launch was given (what it moves if it touches each once), seconds that the host spent in
// calls by kind (launches, waits, copies, builds), and the time between the first and last command. The counting costs
// an event a launch.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include <dlfcn.h>

#define CL_TARGET_OPENCL_VERSION 120
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl.h>

namespace
{

using clock_type = std::chrono::steady_clock;

struct kernel_total
{
    std::uint64_t launches = 0;
    double seconds = 0, bytes = 0;
};

struct call_total
{
    std::uint64_t calls = 0;
    double seconds = 0;
};

struct pending_launch
{
    cl_event event;
    kernel_total* total;
};

class profile
{
public:
    static profile& get()
    {
        static auto* one = new profile; // outlives the destructors of the program
        return *one;
    }

    std::mutex mutex;
    std::unordered_map<cl_kernel, std::string> names;
    std::unordered_map<cl_kernel, std::map<cl_uint, std::size_t>> arguments;
    std::unordered_map<cl_mem, std::size_t> buffers;
    std::map<std::string, kernel_total> kernels;
    std::map<std::string, call_total> calls;
    std::vector<pending_launch> pending;

    void collect()
    {
        for (auto& [event, total] : pending)
        {
            clWaitForEvents(1, &event);
            cl_ulong begin = 0, end = 0;
            clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr);
            clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
            total->seconds += 1e-9 * static_cast<double>(end - begin);
            first = std::min(first, begin), last = std::max(last, end);
            clReleaseEvent(event);
        }
        pending.clear();
    }

private:
    cl_ulong first = ~cl_ulong{0}, last = 0;

    profile()
    {
        std::atexit([] { get().write(); });
    }

    void write()
    {
        const std::lock_guard lock(mutex);
        collect();
        const char* path = std::getenv("OPENCL_PROFILE");
        std::FILE* file = path ? std::fopen(path, "w") : stderr;
        if (!file) return;
        std::fprintf(file, "{\n\"span_seconds\": %.9f,\n\"calls\": {",
                     first < last ? 1e-9 * double(last - first) : 0.0);
        const char* comma = "";
        for (const auto& [name, c] : calls)
        {
            std::fprintf(file, "%s\n  \"%s\": {\"calls\": %llu, \"seconds\": %.6f}", comma, name.c_str(),
                         static_cast<unsigned long long>(c.calls), c.seconds);
            comma = ",";
        }
        std::fprintf(file, "},\n\"kernels\": {");
        comma = "";
        for (const auto& [name, k] : kernels)
        {
            std::fprintf(file, "%s\n  \"%s\": {\"launches\": %llu, \"seconds\": %.9f, \"argument_bytes\": %.0f}", comma,
                         name.c_str(), static_cast<unsigned long long>(k.launches), k.seconds, k.bytes);
            comma = ",";
        }
        std::fprintf(file, "}\n}\n");
        if (path) std::fclose(file);
    }
};

/// The function of the loader behind this one.
template <class F>
F* next(const char* name)
{
    return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}

/// Counts the call and the host's time in it.
template <class Call>
auto counted(const char* kind, Call&& call)
{
    const auto begin = clock_type::now();
    const auto result = call();
    const double seconds = std::chrono::duration<double>(clock_type::now() - begin).count();
    auto& p = profile::get();
    const std::lock_guard lock(p.mutex);
    ++p.calls[kind].calls;
    p.calls[kind].seconds += seconds;
    return result;
}

} // namespace

extern "C"
{

    cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties flags,
                                          cl_int* error)
    {
        static const auto real = next<decltype(clCreateCommandQueue)>("clCreateCommandQueue");
        return real(context, device, flags | CL_QUEUE_PROFILING_ENABLE, error);
    }

    cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* error)
    {
        static const auto real = next<decltype(clCreateBuffer)>("clCreateBuffer");
        const cl_mem made = counted("buffer", [&] { return real(context, flags, size, host, error); });
        auto& p = profile::get();
        const std::lock_guard lock(p.mutex);
        p.buffers[made] = size;
        return made;
    }

    cl_mem clCreateSubBuffer(cl_mem parent, cl_mem_flags flags, cl_buffer_create_type type, const void* region,
                             cl_int* error)
    {
        static const auto real = next<decltype(clCreateSubBuffer)>("clCreateSubBuffer");
        const cl_mem made = real(parent, flags, type, region, error);
        auto& p = profile::get();
        const std::lock_guard lock(p.mutex);
        p.buffers[made] = static_cast<const cl_buffer_region*>(region)->size;
        return made;
    }

    cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* error)
    {
        static const auto real = next<decltype(clCreateKernel)>("clCreateKernel");
        const cl_kernel made = real(program, name, error);
        auto& p = profile::get();
        const std::lock_guard lock(p.mutex);
        p.names[made] = name;
        p.arguments[made].clear();
        return made;
    }

    cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void* value)
    {
        static const auto real = next<decltype(clSetKernelArg)>("clSetKernelArg");
        {
            auto& p = profile::get();
            const std::lock_guard lock(p.mutex);
            std::size_t bytes = 0;
            if (value && size == sizeof(cl_mem))
            {
                cl_mem memory;
                std::memcpy(&memory, value, sizeof memory);
                const auto found = p.buffers.find(memory);
                if (found != p.buffers.end()) bytes = found->second;
            }
            p.arguments[kernel][index] = bytes;
        }
        return real(kernel, index, size, value);
    }

    cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
                                  const size_t* global, const size_t* local, cl_uint waits, const cl_event* wait_list,
                                  cl_event* event)
    {
        static const auto real = next<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
        cl_event own = nullptr;
        const cl_int status = counted(
            "launch", [&]
            { return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event ? event : &own); });
        if (status != CL_SUCCESS) return status;
        if (event)
        {
            own = *event;
            clRetainEvent(own);
        }
        auto& p = profile::get();
        const std::lock_guard lock(p.mutex);
        auto& total = p.kernels[p.names[kernel]];
        ++total.launches;
        for (const auto& [index, bytes] : p.arguments[kernel]) total.bytes += static_cast<double>(bytes);
        p.pending.push_back({own, &total});
        return status;
    }

    cl_int clFinish(cl_command_queue queue)
    {
        static const auto real = next<decltype(clFinish)>("clFinish");
        const cl_int status = counted("finish", [&] { return real(queue); });
        auto& p = profile::get();
        const std::lock_guard lock(p.mutex);
        if (p.pending.size() > 4096) p.collect();
        return status;
    }

    cl_int clFlush(cl_command_queue queue)
    {
        static const auto real = next<decltype(clFlush)>("clFlush");
        return counted("flush", [&] { return real(queue); });
    }

    cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                               void* host, cl_uint waits, const cl_event* wait_list, cl_event* event)
    {
        static const auto real = next<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
        return counted(size > 4096 ? "read" : "read_few",
                       [&] { return real(queue, buffer, blocking, offset, size, host, waits, wait_list, event); });
    }

    cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
                                const void* host, cl_uint waits, const cl_event* wait_list, cl_event* event)
    {
        static const auto real = next<decltype(clEnqueueWriteBuffer)>("clEnqueueWriteBuffer");
        return counted(size > 4096 ? "write" : "write_few",
                       [&] { return real(queue, buffer, blocking, offset, size, host, waits, wait_list, event); });
    }

    cl_int clBuildProgram(cl_program program, cl_uint devices, const cl_device_id* list, const char* options,
                          void (*notify)(cl_program, void*), void* data)
    {
        static const auto real = next<decltype(clBuildProgram)>("clBuildProgram");
        return counted("build", [&] { return real(program, devices, list, options, notify, data); });
    }

} // extern "C"
