// SPDX-License-Identifier: MIT
#include <sstream>

#include <doctest/doctest.h>

#include <taut/impl/core/compute/choose_device.hpp>
#include <taut/impl/core/compute/kernel.hpp>
#include <taut/impl/core/compute/quirks.hpp>

#include "support/contains.hpp"
#include "support/device.hpp"

using taut::test::contains;
using taut::test::with_variable;

namespace
{

std::string refusal_text(const taut::device_requirements& needs = {})
{
    try
    {
        taut::find_device(needs);
    }
    catch (const taut::no_device& e)
    {
        return e.what();
    }
    return {};
}

} // namespace

TEST_CASE("devices: the list has the chosen device, which is described")
{
    const auto all = taut::devices();
    REQUIRE(!all.empty());
    const taut::device chosen = taut::find_device();
    bool listed = false;
    for (const auto& [d, refusal] : all) listed = listed || (d == chosen && refusal.empty());
    CHECK(listed);

    CHECK(!chosen.name().empty());
    CHECK(chosen.compute_units() > 0);
    CHECK(chosen.global_memory() >= chosen.max_allocation());
    CHECK((chosen.is_host() || chosen.opencl_version() >= 120));
    std::ostringstream text;
    text << chosen;
    CHECK(contains(text.str(), chosen.name()));
    CHECK((chosen.is_host() || contains(text.str(), chosen.driver_version())));
}

TEST_CASE("devices: TAUT_DEVICE chooses by index and by a part of a name in any case")
{
    const auto all = taut::devices();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        with_variable wish("TAUT_DEVICE", std::to_string(i));
        CHECK(taut::find_device() == all[i].device);
    }
    std::string part = all[0].device.platform().substr(0, 5);
    for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    with_variable wish("TAUT_DEVICE", part);
    CHECK(taut::find_device().platform() == all[0].device.platform());
}

TEST_CASE("devices: a wish that nothing fulfils names the wish, every platform and device, and the remedy")
{
    const taut::device d = taut::devices()[0].device;
    for (const char* wanted : {"no such machine", "99"})
    {
        with_variable wish("TAUT_DEVICE", wanted);
        const std::string text = refusal_text();
        CHECK(contains(text, std::string("TAUT_DEVICE=") + wanted));
        CHECK(contains(text, d.platform()));
        CHECK(contains(text, d.name() + ": usable"));
        CHECK(contains(text, "pocl-opencl-icd"));
    }
}

TEST_CASE("devices: requirements refuse a device with the reason")
{
    const std::string text = refusal_text({.memory = std::uint64_t{1} << 60});
    CHECK(contains(text, "too little memory"));
    CHECK(contains(text, taut::devices()[0].device.name()));

    const taut::device weak = taut::find_device().without_fp64();
    CHECK(taut::impl::device_refusal(weak).empty());
    CHECK(contains(taut::impl::device_refusal(weak, {.fp64 = true}), "fp64"));
}

TEST_CASE("devices: double is refused by name on a device without fp64, float works")
{
    taut::queue q(taut::find_device().without_fp64());
    taut::buffer<float> narrow(q, 16);
    narrow.fill(2);
    CHECK(narrow.download()[15] == 2);
    try
    {
        taut::buffer<double> wide(q, 16);
        FAIL("a double buffer was allowed");
    }
    catch (const taut::device_error& e)
    {
        CHECK(contains(e.what(), "fp64"));
        CHECK(contains(e.what(), q.device().name()));
        CHECK(e.device() == q.device().label());
    }
    CHECK(q.allocated() == narrow.bytes());
}

TEST_CASE("devices: TAUT_FORM=gpu takes the device for a GPU, and nothing else is known")
{
    const taut::device d = taut::devices()[0].device;
    if (d.is_host()) return; // it has no such form
    with_variable wish("TAUT_DEVICE", "0");
    {
        with_variable form("TAUT_FORM", "gpu");
        const taut::device rehearsed = taut::find_device();
        CHECK(rehearsed.is_gpu());
        CHECK(!rehearsed.is_cpu());
        CHECK(!taut::impl::quirks::wants_serial_items(rehearsed));
    }
    {
        with_variable form("TAUT_FORM", "");
        CHECK(taut::find_device().is_cpu() == d.is_cpu());
    }
    with_variable form("TAUT_FORM", "fpga");
    CHECK_THROWS_AS(taut::find_device(), taut::parameter_error);
}

TEST_CASE("devices: a platform is PoCL or Oclgrind, not both")
{
    const taut::device d = taut::find_device();
    CHECK(!(taut::impl::quirks::is_pocl(d) && taut::impl::quirks::is_oclgrind(d)));
}

TEST_CASE("devices: the host is the last one, and found by its name")
{
    const auto all = taut::devices();
    CHECK(all.back().device.is_host());
    CHECK(all.back().refusal.empty());
    for (std::size_t i = 0; i + 1 < all.size(); ++i) CHECK(!all[i].device.is_host());
    CHECK(taut::find_device("host").is_host());
    CHECK(taut::find_device("Host").has_fp64());
    CHECK_THROWS_AS(taut::find_device("host", {.memory = std::uint64_t{1} << 60}), taut::no_device);
}

TEST_CASE("devices: the host has no handles of OpenCL and compiles no text, and says so")
{
    taut::queue q(taut::device::host());
    const taut::buffer<float> x(q, std::vector<float>(64, 1.0f));
    CHECK_THROWS_WITH_AS(q.native(), doctest::Contains("none of OpenCL's"), taut::device_error);
    CHECK_THROWS_AS(q.native_context(), taut::device_error);
    CHECK_THROWS_AS(x.native(), taut::device_error);
    CHECK_THROWS_WITH_AS(q.kernel<taut::buffer<float>>("__kernel void f(__global float* x) {}", "f"),
                         doctest::Contains("record the kernel"), taut::build_error);
}

// Run by the ctest device.no_platform, with OCL_ICD_VENDORS at an empty folder.
TEST_CASE("devices: without an OpenCL platform the host is there, and a wish for another says what is missing" *
          doctest::skip())
{
    REQUIRE(taut::devices().size() == 1);
    CHECK(taut::queue().device().is_host());
    const with_variable wish("TAUT_DEVICE", "pthread");
    const std::string text = refusal_text();
    CHECK(contains(text, "no OpenCL platform is installed"));
    CHECK(contains(text, std::getenv("OCL_ICD_VENDORS")));
    CHECK(contains(text, "pocl-opencl-icd"));
    CHECK_THROWS_AS(taut::queue(), taut::no_device);
}
