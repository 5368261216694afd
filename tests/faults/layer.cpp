// SPDX-License-Identifier: MIT
//
// An OpenCL layer (OPENCL_LAYERS=this library) that makes one call of a program fail, or all calls from one on.
//
//     TAUT_FAULT=launch:7      the 7th kernel launch fails; kinds below, 0: none
//     TAUT_FAULT_LOG=FILE      gets a line "KIND COUNT" of calls at the end, and "fired" as soon as the fault was made
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#define CL_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl_layer.h>

namespace
{

enum kind : std::size_t
{
    context,
    queue,
    allocate,
    program,
    build,
    kernel,
    argument,
    launch,
    read,
    write,
    fill,
    copy,
    finish,
    kinds
};
constexpr const char* names[] = {"context", "queue", "allocate", "program", "build", "kernel", "argument",
                                 "launch",  "read",  "write",    "fill",    "copy",  "finish"};
static_assert(std::size(names) == kinds);

/// What is to happen, from the environment.
struct plan
{
    std::string kind; ///< a name of above, "nan" (what the n-th launch wrote is overwritten by NaN) or "lost" (every
                      ///< call from the n-th launch on fails)
    unsigned long n = 0;
    std::string log;

    plan()
    {
        if (const char* fault = std::getenv("TAUT_FAULT"))
        {
            const char* colon = std::strchr(fault, ':');
            kind = colon ? std::string(fault, colon) : fault;
            n = colon ? std::strtoul(colon + 1, nullptr, 10) : 1;
        }
        if (const char* file = std::getenv("TAUT_FAULT_LOG")) log = file;
    }
};

struct layer_state
{
    plan wanted;
    cl_icd_dispatch target{}, table{};
    std::atomic<unsigned long> counts[kinds]{};
    std::atomic<bool> lost{false};
    std::mutex lock;
    std::unordered_map<cl_kernel, std::unordered_map<cl_uint, cl_mem>> arguments;

    void say(const std::string& line) const
    {
        if (!wanted.log.empty()) std::ofstream(wanted.log, std::ios::app) << line << '\n';
    }

    /// Counts a call; whether it is to fail.
    bool fails(enum kind k)
    {
        const unsigned long now = ++counts[k];
        if (wanted.kind == "lost" && k == launch && now == wanted.n && !lost.exchange(true)) say("fired");
        if (lost) return true;
        if (wanted.n != now || wanted.kind != names[k]) return false;
        say("fired");
        return true;
    }
};

/// Never destroyed: the program's own destructors still call the driver.
layer_state& state()
{
    static layer_state& only = *new layer_state;
    return only;
}

void write_counts()
{
    for (std::size_t k = 0; k < kinds; ++k) state().say(names[k] + (' ' + std::to_string(state().counts[k])));
}

void tell(cl_int* code, cl_int value)
{
    if (code) *code = value;
}

constexpr cl_int gone = CL_DEVICE_NOT_AVAILABLE;

/// The error of a call that fails: the usual one of its kind, or that of a device that is no more.
cl_int error_of(cl_int usual)
{
    return state().lost ? gone : usual;
}

cl_context CL_API_CALL create_context(const cl_context_properties* properties, cl_uint count,
                                      const cl_device_id* devices,
                                      void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*), void* data,
                                      cl_int* code)
{
    if (!state().fails(context)) return state().target.clCreateContext(properties, count, devices, notify, data, code);
    tell(code, error_of(CL_OUT_OF_HOST_MEMORY));
    return nullptr;
}

cl_command_queue CL_API_CALL create_queue(cl_context where, cl_device_id device, cl_command_queue_properties properties,
                                          cl_int* code)
{
    if (!state().fails(queue)) return state().target.clCreateCommandQueue(where, device, properties, code);
    tell(code, error_of(CL_OUT_OF_RESOURCES));
    return nullptr;
}

cl_mem CL_API_CALL create_buffer(cl_context where, cl_mem_flags flags, size_t size, void* host, cl_int* code)
{
    if (!state().fails(allocate)) return state().target.clCreateBuffer(where, flags, size, host, code);
    tell(code, error_of(CL_MEM_OBJECT_ALLOCATION_FAILURE));
    return nullptr;
}

cl_program CL_API_CALL create_program(cl_context where, cl_uint count, const char** texts, const size_t* lengths,
                                      cl_int* code)
{
    if (!state().fails(program)) return state().target.clCreateProgramWithSource(where, count, texts, lengths, code);
    tell(code, error_of(CL_OUT_OF_HOST_MEMORY));
    return nullptr;
}

cl_int CL_API_CALL build_program(cl_program text, cl_uint count, const cl_device_id* devices, const char* options,
                                 void(CL_CALLBACK* notify)(cl_program, void*), void* data)
{
    if (state().fails(build)) return error_of(CL_BUILD_PROGRAM_FAILURE);
    if (state().wanted.kind != "nan") return state().target.clBuildProgram(text, count, devices, options, notify, data);
    // What a kernel wrote is told by the types of its arguments.
    const std::string more = std::string(options ? options : "") + " -cl-kernel-arg-info";
    return state().target.clBuildProgram(text, count, devices, more.c_str(), notify, data);
}

cl_kernel CL_API_CALL create_kernel(cl_program text, const char* name, cl_int* code)
{
    if (!state().fails(kernel)) return state().target.clCreateKernel(text, name, code);
    tell(code, error_of(CL_OUT_OF_HOST_MEMORY));
    return nullptr;
}

cl_int CL_API_CALL set_argument(cl_kernel k, cl_uint i, size_t size, const void* value)
{
    if (state().fails(argument)) return error_of(CL_OUT_OF_RESOURCES);
    if (size == sizeof(cl_mem) && value)
    {
        cl_mem memory = nullptr;
        std::memcpy(&memory, value, sizeof memory);
        const std::lock_guard guard(state().lock);
        state().arguments[k][i] = memory;
    }
    return state().target.clSetKernelArg(k, i, size, value);
}

std::string type_of(cl_kernel k, cl_uint i)
{
    char name[64] = {};
    if (state().target.clGetKernelArgInfo(k, i, CL_KERNEL_ARG_TYPE_NAME, sizeof name - 1, name, nullptr) != CL_SUCCESS)
        return {};
    return name;
}

/// Overwrites what the kernel may have written, as far as it is floating point; nothing where the driver does not keep
/// the types of arguments.
void spoil(cl_command_queue q, cl_kernel k)
{
    std::vector<cl_mem> outputs;
    {
        const std::lock_guard guard(state().lock);
        for (const auto& [i, memory] : state().arguments[k])
        {
            cl_kernel_arg_type_qualifier qualifier = 0;
            state().target.clGetKernelArgInfo(k, i, CL_KERNEL_ARG_TYPE_QUALIFIER, sizeof qualifier, &qualifier,
                                              nullptr);
            const std::string type = type_of(k, i);
            const bool number = type == "float*" || type == "double*";
            if (number && !(qualifier & CL_KERNEL_ARG_TYPE_CONST)) outputs.push_back(memory);
        }
    }
    if (!outputs.empty()) state().say("fired");
    const cl_uint nan = 0xffffffff;
    for (cl_mem memory : outputs)
    {
        size_t size = 0;
        state().target.clGetMemObjectInfo(memory, CL_MEM_SIZE, sizeof size, &size, nullptr);
        state().target.clEnqueueFillBuffer(q, memory, &nan, sizeof nan, 0, size, 0, nullptr, nullptr);
    }
}

cl_int CL_API_CALL enqueue_kernel(cl_command_queue q, cl_kernel k, cl_uint dimensions, const size_t* offset,
                                  const size_t* global, const size_t* local, cl_uint count, const cl_event* before,
                                  cl_event* done)
{
    if (state().fails(launch)) return error_of(CL_OUT_OF_RESOURCES);
    const cl_int code =
        state().target.clEnqueueNDRangeKernel(q, k, dimensions, offset, global, local, count, before, done);
    if (state().wanted.kind == "nan" && state().counts[launch] == state().wanted.n) spoil(q, k);
    return code;
}

cl_int CL_API_CALL enqueue_read(cl_command_queue q, cl_mem memory, cl_bool wait, size_t offset, size_t size, void* to,
                                cl_uint count, const cl_event* before, cl_event* done)
{
    if (state().fails(read)) return error_of(CL_OUT_OF_RESOURCES);
    return state().target.clEnqueueReadBuffer(q, memory, wait, offset, size, to, count, before, done);
}

cl_int CL_API_CALL enqueue_write(cl_command_queue q, cl_mem memory, cl_bool wait, size_t offset, size_t size,
                                 const void* from, cl_uint count, const cl_event* before, cl_event* done)
{
    if (state().fails(write)) return error_of(CL_OUT_OF_RESOURCES);
    return state().target.clEnqueueWriteBuffer(q, memory, wait, offset, size, from, count, before, done);
}

cl_int CL_API_CALL enqueue_fill(cl_command_queue q, cl_mem memory, const void* pattern, size_t width, size_t offset,
                                size_t size, cl_uint count, const cl_event* before, cl_event* done)
{
    if (state().fails(fill)) return error_of(CL_OUT_OF_RESOURCES);
    return state().target.clEnqueueFillBuffer(q, memory, pattern, width, offset, size, count, before, done);
}

cl_int CL_API_CALL enqueue_copy(cl_command_queue q, cl_mem from, cl_mem to, size_t from_offset, size_t to_offset,
                                size_t size, cl_uint count, const cl_event* before, cl_event* done)
{
    if (state().fails(copy)) return error_of(CL_OUT_OF_RESOURCES);
    return state().target.clEnqueueCopyBuffer(q, from, to, from_offset, to_offset, size, count, before, done);
}

cl_int CL_API_CALL finish_queue(cl_command_queue q)
{
    if (state().fails(finish)) return error_of(CL_OUT_OF_RESOURCES);
    return state().target.clFinish(q);
}

} // namespace

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, size_t size, void* value, size_t* needed)
{
    if (name != CL_LAYER_API_VERSION) return CL_INVALID_VALUE;
    constexpr cl_layer_api_version version = CL_LAYER_API_VERSION_100;
    if (value && size < sizeof version) return CL_INVALID_VALUE;
    if (value) std::memcpy(value, &version, sizeof version);
    if (needed) *needed = sizeof version;
    return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint count, const cl_icd_dispatch* target, cl_uint* used,
                                            const cl_icd_dispatch** table)
{
    auto& s = state();
    if (!target || !used || !table || count * sizeof(void*) > sizeof s.target) return CL_INVALID_VALUE;
    std::memcpy(&s.target, target, count * sizeof(void*));
    s.table = s.target;
    s.table.clCreateContext = create_context;
    s.table.clCreateCommandQueue = create_queue;
    s.table.clCreateBuffer = create_buffer;
    s.table.clCreateProgramWithSource = create_program;
    s.table.clBuildProgram = build_program;
    s.table.clCreateKernel = create_kernel;
    s.table.clSetKernelArg = set_argument;
    s.table.clEnqueueNDRangeKernel = enqueue_kernel;
    s.table.clEnqueueReadBuffer = enqueue_read;
    s.table.clEnqueueWriteBuffer = enqueue_write;
    s.table.clEnqueueFillBuffer = enqueue_fill;
    s.table.clEnqueueCopyBuffer = enqueue_copy;
    s.table.clFinish = finish_queue;
    *used = count;
    *table = &s.table;
    std::atexit(write_counts);
    return CL_SUCCESS;
}
