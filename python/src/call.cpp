// SPDX-License-Identifier: BSD-3-Clause
#include "call.h"
#include "documents.h"
#include <algorithm>
#include <fresco/core/mesh.h>
#include <pybind11/eval.h>
namespace fresco::python {
namespace {
/// The comment of a function of the headers, as Python words it.
std::string documentOf(const std::string& core)
{
  for (const auto& [name, text] : documents)
    if (core == name)
      return text;
  throw std::logic_error("no header documents " + core + "()");
}

/// "depth=8, *, threads=0" as in a signature; with types for the stubs.
std::string parametersText(const Function& function, const std::vector<Option>& options, bool with_types)
{
  std::string text;
  const auto add = [&](const std::string& name, const std::string& type, const std::string& value) {
    text += (text.empty() ? "" : ", ") + name;
    if (with_types)
      text += ": " + type;
    if (!value.empty())
      text += with_types ? " = " + value : "=" + value;
  };
  for (const Argument& argument : function.arguments)
    add(argument.name, argument.type, argument.default_value ? argument.default_value : "");
  if (!options.empty() || function.has_progress)
    text += text.empty() ? "*" : ", *";
  for (const Option& option : options)
    add(option.name, option.type, option.default_value);
  if (function.has_progress)
    add("progress", "Optional[Progress]", "None");
  return text;
}

std::string documentText(const Function& function, const std::vector<Option>& options, const std::string& options_text)
{
  std::string text = wrapped(options_text, "");
  if (!text.empty())
    text += "\n";
  if (*function.core)
    text += wrapped(documentOf(function.core), "") + "\n";
  text += wrapped(function.note, "");
  text += "\nTypes:\n";
  for (const Argument& argument : function.arguments)
    text += concat("    ", argument.name, ": ", argument.type, "\n");
  text += concat("    returns ", function.result, "\n");
  if (!options.empty())
    text += "\nOptions:\n";
  for (const Option& option : options)
    text += concat("    ", option.name, ": ", option.type, " = ", option.default_value, "\n",
                   wrapped(option.text, "        "));
  if (function.has_progress)
    text +=
        "\n`progress(step, fraction)` is told each step and the share done, 0..1; returning False, or an exception,\n"
        "stops the call.\n";
  return text;
}

py::object unexpected(const Function& function, const std::string& name, const std::vector<Option>& options)
{
  py::list known;
  for (const Argument& argument : function.arguments)
    known.append(argument.name);
  for (const Option& option : options)
    known.append(option.name);
  return py::module_::import("fresco._base").attr("unexpected")(function.name, toText(name), known);
}
} // namespace

Call::Call(const Function& function, const std::vector<Option>& options, const py::args& values,
           const py::kwargs& named)
    : named_(named.attr("copy")())
{
  const auto& wanted = function.arguments;
  if (values.size() > wanted.size())
    throw py::type_error(
        concat(function.name, "() takes ", wanted.size(), " arguments without a name, not ", values.size()));
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const char* const name = wanted[i].name;
    const bool is_named = named_.contains(name);
    if (i < values.size() && is_named)
      throw py::type_error(concat(function.name, "() got '", name, "' twice"));
    if (i >= values.size() && !is_named && !wanted[i].default_value)
      throw py::type_error(concat(function.name, "() wants '", name, "'"));
    if (i < values.size())
      arguments_[name] = values[i];
    else if (is_named)
      arguments_[name] = named_.attr("pop")(name);
    else
      arguments_[name] = py::eval(wanted[i].default_value);
  }
  for (const auto& [key, value] : named_) {
    const std::string name = py::str(key);
    const auto same = [&](const Option& option) { return option.name == name; };
    if (std::none_of(options.begin(), options.end(), same) && !(function.has_progress && name == "progress")) {
      const py::object error = unexpected(function, name, options);
      PyErr_SetObject(PyExc_TypeError, error.ptr());
      throw py::error_already_set();
    }
  }
}

Call::Listener::Listener(py::object callable) : callable_(std::move(callable))
{
  if (!callable_.is_none() && !PyCallable_Check(callable_.ptr()))
    throwWrongType("progress", callable_, "a callable");
}

Progress Call::Listener::progress()
{
  return [this](std::string_view step, double fraction) {
    const Turn::Asked turn;
    try {
      return turn && !error_ && hear(step, fraction);
    } catch (py::error_already_set& error) {
      error_.emplace(std::move(error));
      return false;
    }
  };
}

bool Call::Listener::hear(std::string_view step, double fraction)
{
  if (PyErr_CheckSignals() != 0)
    throw py::error_already_set();
  return callable_.is_none() || callable_(toText(step), fraction).ptr() != Py_False;
}

void Call::Listener::rethrow()
{
  if (error_)
    throw py::error_already_set(std::move(*error_));
}

void addFunction(const py::module_& module, const Function& function, const std::vector<Option>& options,
                 const std::string& options_text, const CallBody& body)
{
  const std::string text = concat(function.name, "(", parametersText(function, options, false), ")\n--\n\n",
                                  documentText(function, options, options_text));
  const auto call = [function, options, body](const py::args& values, const py::kwargs& named) {
    const Turn turn;
    return body(Call(function, options, values, named));
  };
  py::options plain;
  plain.disable_function_signatures();
  py::cpp_function added(call, py::name(function.name), py::scope(module), py::doc(text.c_str()));
  added.attr("__module__") = "fresco";
  module.attr(function.name) = added;
  stubs() += concat("def ", function.name, "(", parametersText(function, options, true), ") -> ", function.result,
                    ": ...\n\n");
}

std::mutex& oneAtATime()
{
  static std::mutex mutex;
  return mutex;
}

namespace {
/// An argument whose attribute `rows` must have some.
template <typename T>
Lent<T> lendFilled(const Call& call, const char* argument, const char* rows, void (*validate)(const T&))
{
  const py::object value = call[argument];
  Convert<T>::check(value, argument);
  if (py::len(value.attr(rows)) == 0)
    throw py::value_error(concat(argument, ": no ", rows));
  validate(*call.lend<T>(argument));
  return call.lend<T>(argument);
}
} // namespace

Lent<PointSet> lendPoints(const Call& call, const char* argument)
{
  return lendFilled<PointSet>(call, argument, "points", validatePointSet);
}

Lent<TriangleMesh> lendMesh(const Call& call, const char* argument)
{
  return lendFilled<TriangleMesh>(call, argument, "vertices", validateMesh);
}
} // namespace fresco::python
