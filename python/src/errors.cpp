// SPDX-License-Identifier: MIT
#include "errors.hpp"

#include <exception>
#include <vector>

#include <taut/atlas.hpp>
#include <taut/errors.hpp>
#include <taut/kernel.hpp>
#include <taut/paste.hpp>
#include <taut/volume_file.hpp>

namespace taut::python
{

namespace
{

namespace nb = nanobind;

/// Raises an exception of taut.errors; fields become attributes.
void raise(const char* type, const char* what, const nb::dict& fields = {})
{
    const nb::object exception = nb::module_::import_("taut.errors").attr(type)(what, **fields);
    PyErr_SetObject(exception.type().ptr(), exception.ptr());
}

nb::list list_of(const std::vector<idx>& ids)
{
    nb::list all;
    for (const idx id : ids) all.append(nb::int_(id));
    return all;
}

template <class... Fields>
nb::dict with(Fields&&... fields)
{
    nb::dict d;
    const auto add = [&](const auto& field) { d[field.first] = field.second; };
    (add(fields), ...);
    return d;
}

auto named(const char* name, nb::object value)
{
    return std::pair<const char*, nb::object>(name, std::move(value));
}

nb::list findings_of(const repair_error& e)
{
    nb::list all;
    for (const auto& f : e.findings()) all.append(nb::str(f.message().c_str()));
    return all;
}

void translate(const std::exception_ptr& thrown, void*)
{
    try
    {
        std::rethrow_exception(thrown);
    }
    catch (const parameter_error& e)
    {
        raise("ParameterError", e.what(), with(named("field", nb::str(e.field().c_str()))));
    }
    catch (const mesh_error& e)
    {
        raise("MeshError", e.what(),
              with(named("ids", list_of(e.ids())), named("fault", nb::str(to_string(e.fault())))));
    }
    catch (const constraint_error& e)
    {
        raise("ConstraintError", e.what(),
              with(named("ids", list_of(e.ids())), named("fault", nb::str(to_string(e.fault())))));
    }
    catch (const repair_error& e)
    {
        raise("MeshError", e.what(), with(named("fault", nb::str("empty")), named("notes", findings_of(e))));
    }
    catch (const symmetry_error& e)
    {
        raise("MeshError", e.what(),
              with(named("ids", list_of(e.vertices())), named("fault", nb::str("not_symmetric"))));
    }
    catch (const io::texcoord_error& e)
    {
        raise("MeshError", e.what(), with(named("ids", list_of({e.vertex()})), named("fault", nb::str("texcoord"))));
    }
    catch (const io::io_error& e)
    {
        raise("FileError", e.what(), with(named("path", nb::str(e.path().c_str()))));
    }
    catch (const no_device& e)
    {
        raise("DeviceError", e.what());
    }
    catch (const build_error& e)
    {
        raise("DeviceError", e.what(), with(named("kernel", nb::str(e.kernel().c_str()))));
    }
    catch (const device_error& e)
    {
        raise("DeviceError", e.what(), with(named("device", nb::str(e.device().c_str()))));
    }
    catch (const tape_error& e)
    {
        raise("TraceError", e.what());
    }
    catch (const error& e) // of pastes, regions, groups, packing
    {
        raise("TautError", e.what());
    }
}

} // namespace

void add_errors(nb::module_&)
{
    nb::register_exception_translator(translate);
}

} // namespace taut::python
