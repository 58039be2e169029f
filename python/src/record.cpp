// SPDX-License-Identifier: BSD-3-Clause
#include "record.h"
#include <sstream>
namespace fresco::python {
py::handle makeRecord(const py::module_& module, const std::string& name, const std::string& text,
                      const std::vector<Attribute>& attributes, const py::object& defaults)
{
  py::dict slots, checks, body;
  std::string fields, parameters;
  for (const Attribute& attribute : attributes) {
    slots[attribute.name.c_str()] = concat(attribute.annotation, attribute.text.empty() ? "" : ": ", attribute.text);
    checks[attribute.name.c_str()] = attribute.check;
    fields += concat("    ", attribute.name, ": ", attribute.annotation, "\n");
    const bool is_array = attribute.annotation == "Floats" || attribute.annotation == "Ints" ||
                          attribute.annotation == "Bytes" || attribute.annotation == "Doubles";
    parameters += concat(", ", attribute.name, ": ", is_array ? "ArrayLike" : attribute.annotation, " = ...");
  }
  body["__slots__"] = slots;
  body["__doc__"] = wrapped(text, "");
  body["__module__"] = "fresco";
  body["_checks"] = checks;
  body["_defaults"] = py::module_::import("builtins").attr("staticmethod")(defaults);
  const py::module_ shapes = py::module_::import("fresco._geometry");
  const std::string of_shape = name + "Base", base_name = py::hasattr(shapes, of_shape.c_str()) ? of_shape : "Record";
  const py::object base = shapes.attr(base_name.c_str());
  const py::object cls = py::module_::import("builtins").attr("type")(name, py::make_tuple(base), body);
  module.attr(name.c_str()) = cls;
  stubs() +=
      concat("class ", name, "(", base_name, "):\n", fields, "    def __init__(self", parameters, ") -> None: ...\n\n");
  return py::object(cls).release(); // classes live as long as the process
}

std::string& stubs()
{
  static std::string text;
  return text;
}

std::string wrapped(const std::string& text, const std::string& indent)
{
  constexpr std::size_t widest = 100;
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t words_begin = line.find_first_not_of(' ');
    const std::string hang = indent + std::string(words_begin == std::string::npos ? 0 : words_begin, ' ');
    std::string row = hang;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (row.size() > hang.size() && row.size() + 1 + word.size() > widest) {
        out += row + "\n";
        row = hang;
      }
      row += (row.size() > hang.size() ? " " : "") + word;
    }
    out += (words_begin == std::string::npos ? "" : row) + "\n";
  }
  return out;
}
} // namespace fresco::python
