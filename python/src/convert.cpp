// SPDX-License-Identifier: BSD-3-Clause
#include "convert.h"
namespace fresco::python {
std::string typeNameOf(py::handle value) { return py::str(py::type::of(value).attr("__name__")); }

void throwWrongType(const std::string& name, py::handle value, const std::string& wanted)
{
  throw py::type_error(concat(name, ": ", typeNameOf(value), ", wanted ", wanted));
}

long long toInteger(py::handle value, const std::string& name, long long least, long long most)
{
  const auto integer =
      py::reinterpret_steal<py::object>(PyBool_Check(value.ptr()) ? nullptr : PyNumber_Index(value.ptr()));
  if (!integer) {
    PyErr_Clear();
    throwWrongType(name, value, "int");
  }
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(integer.ptr(), &overflow);
  if (overflow != 0 || number < least || number > most)
    throw py::value_error(concat(name, ": ", std::string(py::str(integer)), " is not in ", least, "..", most));
  return number;
}

double toNumber(py::handle value, const std::string& name)
{
  const double number = PyBool_Check(value.ptr()) ? -1.0 : PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && (PyErr_Occurred() || PyBool_Check(value.ptr()))) {
    PyErr_Clear();
    throwWrongType(name, value, "float");
  }
  return number;
}

bool toBool(py::handle value, const std::string& name)
{
  py::detail::make_caster<bool> caster;
  if (!caster.load(value, false)) // numpy's bool, too
    throwWrongType(name, value, "bool");
  return py::detail::cast_op<bool>(caster);
}

std::string toString(py::handle value, const std::string& name)
{
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(value.ptr(), &bytes) == 0) {
    PyErr_Clear();
    throwWrongType(name, value, "str or a path, without a character 0");
  }
  return py::reinterpret_steal<py::bytes>(bytes);
}

std::vector<py::object> toEntries(py::handle value, const std::string& name, const std::string& of)
{
  const bool single = PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) ||
                      py::isinstance(value, py::module_::import("fresco._base").attr("Record"));
  const auto entries = py::reinterpret_steal<py::object>(single ? nullptr : PySequence_Fast(value.ptr(), ""));
  if (!entries) {
    PyErr_Clear();
    throwWrongType(name, value, "a list of " + of);
  }
  const auto sequence = py::reinterpret_borrow<py::sequence>(entries);
  return {sequence.begin(), sequence.end()};
}

py::object newRecord(py::handle cls)
{
  auto* const type = reinterpret_cast<PyTypeObject*>(cls.ptr());
  const auto record = py::reinterpret_steal<py::object>(type->tp_alloc(type, 0));
  if (!record)
    throw py::error_already_set();
  return record;
}

py::object indicesOf(const py::object& value)
{
  const py::module_ numpy = py::module_::import("numpy");
  const auto array = py::array::ensure(value);
  const bool is_mask = array && array.ndim() == 1 && array.dtype().kind() == 'b';
  PyErr_Clear();
  return is_mask ? py::object(numpy.attr("flatnonzero")(array)) : value;
}

std::string literalText(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += concat(text.empty() ? "" : ", ", "'", word, "'");
  return "Literal[" + text + "]";
}
} // namespace fresco::python
