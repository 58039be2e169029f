// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "convert.h"
namespace fresco::python {
/// One attribute of a class: what Python sees of a field.
struct Attribute {
  std::string name, annotation, text;
  py::object check; ///< callable: the value as it is kept, or an exception
};

/// Makes the class `name` of the module, derived from fresco._base.Record, and its lines in the stubs.
/// @param defaults callable: the attributes of a new object by name
py::handle makeRecord(const py::module_& module, const std::string& name, const std::string& text,
                      const std::vector<Attribute>& attributes, const py::object& defaults);

/// The class of a struct, with an attribute per field.
template <typename T>
void addRecord(const py::module_& module)
{
  std::vector<Attribute> attributes;
  Fields<T>::visit([&](const char* name, auto member, const char* text) {
    using Member = std::decay_t<decltype(std::declval<T&>().*member)>;
    const auto check = [name](const py::object& value) { return Convert<Member>::check(value, name); };
    attributes.push_back({name, Convert<Member>::annotation(), text, py::cpp_function(check)});
  });
  const auto defaults = [] {
    py::dict values;
    T fresh{};
    Fields<T>::visit(
        [&](const char* name, auto member, const char*) { values[name] = python::toPython(std::move(fresh.*member)); });
    return values;
  };
  recordClass<T>() = makeRecord(module, Fields<T>::name, Fields<T>::text, attributes, py::cpp_function(defaults));
}

/// Lines of the stubs of all that was added so far.
std::string& stubs();

/// `text` in lines of at most 100 letters, each behind `indent`; lines that are short enough stay.
std::string wrapped(const std::string& text, const std::string& indent);
} // namespace fresco::python
