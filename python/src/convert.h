// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "arrays.h"
#include "fields.h"
#include <array>
#include <charconv>
#include <fresco/core/require.h>
#include <map>
#include <optional>
#include <pybind11/pybind11.h>
/// Values of C++ in Python and back. Convert<T> has
///   toPython(T&&)                       the value in Python; arrays are moved, not copied
///   fill(T&, value, name, lender)       from Python; arrays are borrowed while `lender` lives
///   check(value, name)                  `value` as an attribute keeps it; throws if fill() would
///   annotation()                        the type in the stubs
namespace fresco::python {
template <typename T, typename = void>
struct Convert;

template <typename T, typename = void>
constexpr bool has_fields = false;
template <typename T>
constexpr bool has_fields<T, std::void_t<decltype(Fields<T>::name)>> = true;

template <typename T>
py::object toPython(T value)
{
  return Convert<T>::toPython(std::move(value));
}

/// Text from C++ may hold names of files, which are any bytes.
inline py::object toText(std::string_view text)
{
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<Py_ssize_t>(text.size())));
}

std::string typeNameOf(py::handle value);
[[noreturn]] void throwWrongType(const std::string& name, py::handle value, const std::string& wanted);
long long toInteger(py::handle value, const std::string& name, long long least, long long most);
double toNumber(py::handle value, const std::string& name);
bool toBool(py::handle value, const std::string& name);
std::string toString(py::handle value, const std::string& name);
/// The entries of anything but a text that can be gone through.
std::vector<py::object> toEntries(py::handle value, const std::string& name, const std::string& of);

/// check() by way of fill().
template <typename T>
struct CheckedByFilling {
  static py::object check(const py::object& value, const std::string& name)
  {
    T filled{};
    Lender lender;
    Convert<T>::fill(filled, value, name, lender);
    return value;
  }
};

template <>
struct Convert<bool> : CheckedByFilling<bool> {
  static py::object toPython(bool value) { return py::bool_(value); }
  static void fill(bool& out, py::handle value, const std::string& name, Lender&) { out = toBool(value, name); }
  static std::string annotation() { return "bool"; }
};

template <typename T>
struct Convert<T, std::enable_if_t<std::is_integral_v<T>>> : CheckedByFilling<T> {
  static py::object toPython(T value) { return py::int_(value); }
  static void fill(T& out, py::handle value, const std::string& name, Lender&)
  {
    constexpr auto most = std::numeric_limits<T>::max();
    constexpr long long limit = sizeof(T) < sizeof(long long) ? most : std::numeric_limits<long long>::max();
    out = static_cast<T>(toInteger(value, name, std::numeric_limits<T>::min(), limit));
  }
  static std::string annotation() { return "int"; }
};

template <typename T>
struct Convert<T, std::enable_if_t<std::is_floating_point_v<T>>> : CheckedByFilling<T> {
  static py::object toPython(T value) { return py::float_(value); }
  static void fill(T& out, py::handle value, const std::string& name, Lender&)
  {
    out = static_cast<T>(toNumber(value, name));
  }
  static std::string annotation() { return "float"; }
};

template <>
struct Convert<std::string> : CheckedByFilling<std::string> {
  static py::object toPython(const std::string& value) { return toText(value); }
  static void fill(std::string& out, py::handle value, const std::string& name, Lender&)
  {
    out = toString(value, name);
  }
  static std::string annotation() { return "str"; }
};

/// "Literal['a', 'b']"
std::string literalText(const std::vector<std::string>& words);

/// Enumerators by name.
template <typename T>
struct Convert<T, std::enable_if_t<std::is_enum_v<T>>> : CheckedByFilling<T> {
  static py::object toPython(T value)
  {
    for (const auto& [enumerator, name] : Enumerators<T>::all)
      if (enumerator == value)
        return py::str(name);
    return py::none();
  }
  static void fill(T& out, py::handle value, const std::string& name, Lender&)
  {
    const std::string given = toString(value, name);
    std::string known;
    for (const auto& [enumerator, word] : Enumerators<T>::all) {
      if (given == word) {
        out = enumerator;
        return;
      }
      known += (known.empty() ? "" : ", ") + std::string(word);
    }
    throw py::value_error(concat(name, ": '", given, "' is none of ", known));
  }
  static std::string annotation()
  {
    std::vector<std::string> words;
    for (const auto& [enumerator, word] : Enumerators<T>::all)
      words.emplace_back(word);
    return literalText(words);
  }
};

template <typename T>
struct Convert<std::optional<T>> : CheckedByFilling<std::optional<T>> {
  static py::object toPython(std::optional<T> value)
  {
    return value ? Convert<T>::toPython(std::move(*value)) : py::none();
  }
  static void fill(std::optional<T>& out, py::handle value, const std::string& name, Lender& lender)
  {
    out.reset();
    if (!value.is_none())
      Convert<T>::fill(out.emplace(), value, name, lender);
  }
  static std::string annotation() { return "Optional[" + Convert<T>::annotation() + "]"; }
};

template <typename T>
struct Convert<std::vector<T>> : CheckedByFilling<std::vector<T>> {
  static py::object toPython(std::vector<T> values)
  {
    py::list list;
    for (T& value : values)
      list.append(Convert<T>::toPython(std::move(value)));
    return std::move(list);
  }
  static void fill(std::vector<T>& out, py::handle value, const std::string& name, Lender& lender)
  {
    const std::vector<py::object> entries = toEntries(value, name, Convert<T>::annotation());
    out = std::vector<T>(entries.size()); // they stay where they are: some borrow
    for (std::size_t i = 0; i < entries.size(); ++i)
      Convert<T>::fill(out[i], entries[i], concat(name, '[', i, ']'), lender);
  }
  static std::string annotation() { return "list[" + Convert<T>::annotation() + "]"; }
};

/// A mask as the indices of its true entries; all else as it is.
py::object indicesOf(const py::object& value);

template <>
struct Convert<std::vector<Index>> : CheckedByFilling<std::vector<Index>> {
  static py::object toPython(std::vector<Index> values) { return toArray(std::move(values)); }
  static void fill(std::vector<Index>& out, py::handle given, const std::string& name, Lender&)
  {
    const py::object value = indicesOf(py::reinterpret_borrow<py::object>(given));
    const py::array array = checkedArray(value, name, py::dtype::of<Index>(), 1);
    const auto* const data = static_cast<const Index*>(array.data());
    out.assign(data, data + array.size());
  }
  static std::string annotation() { return "Indices"; }
};

template <typename T, std::size_t n>
struct Convert<std::array<T, n>> : CheckedByFilling<std::array<T, n>> {
  static py::object toPython(const std::array<T, n>& values)
  {
    return py::tuple(Convert<std::vector<T>>::toPython({values.begin(), values.end()}));
  }
  static void fill(std::array<T, n>& out, py::handle value, const std::string& name, Lender& lender)
  {
    std::vector<T> values;
    Convert<std::vector<T>>::fill(values, value, name, lender);
    if (values.size() != n)
      throw py::value_error(concat(name, ": ", values.size(), " values, wanted ", n));
    std::copy(values.begin(), values.end(), out.begin());
  }
  static std::string annotation() { return "Sequence[" + Convert<T>::annotation() + "]"; }
};

/// Names with values: a dictionary.
template <typename T>
struct Convert<std::map<std::string, T>> {
  static py::object check(const py::object& value, const std::string& name)
  {
    if (!py::isinstance<py::dict>(value))
      throwWrongType(name, value, "dict");
    py::dict checked;
    for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value))
      checked[key] =
          Convert<T>::check(py::reinterpret_borrow<py::object>(entry), concat(name, "['", toString(key, name), "']"));
    return std::move(checked);
  }
  static py::object toPython(std::map<std::string, T> values)
  {
    py::dict entries;
    for (auto& [name, value] : values)
      entries[toText(name)] = Convert<T>::toPython(std::move(value));
    return std::move(entries);
  }
  static void fill(std::map<std::string, T>& out, py::handle value, const std::string& name, Lender& lender)
  {
    out.clear();
    if (!py::isinstance<py::dict>(value))
      throwWrongType(name, value, "dict");
    for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value)) {
      const std::string word = toString(key, name);
      Convert<T>::fill(out[word], entry, concat(name, "['", word, "']"), lender);
    }
  }
  static std::string annotation() { return "dict[str, " + Convert<T>::annotation() + "]"; }
};
template <typename T>
struct Convert<std::vector<std::pair<std::string, T>>> : Convert<std::map<std::string, T>> {
  static py::object toPython(std::vector<std::pair<std::string, T>> values)
  {
    py::dict entries; // in their order
    for (auto& [name, value] : values)
      entries[toText(name)] = Convert<T>::toPython(std::move(value));
    return std::move(entries);
  }
  static void fill(std::vector<std::pair<std::string, T>>& out, py::handle value, const std::string& name,
                   Lender& lender)
  {
    std::map<std::string, T> values;
    Convert<std::map<std::string, T>>::fill(values, value, name, lender);
    out.assign(values.begin(), values.end());
  }
  static py::object check(const py::object& value, const std::string& name)
  {
    return Convert<std::map<std::string, T>>::check(value, name);
  }
};

template <>
struct Convert<Image> {
  static py::object toPython(Image image) { return toArray(std::move(image)); }
  static void fill(Image& out, py::handle value, const std::string& name, Lender&) { out = toImage(value, name); }
  static py::object check(const py::object& value, const std::string& name)
  {
    return value.is_none() || toImage(value, name).empty() ? toArray(Image()) : value;
  }
  static std::string annotation() { return "Bytes"; }
};

/// Matrices with a column per element, and vectors with a row: arrays without a copy.
template <typename Scalar, int rows, int columns>
struct Convert<Eigen::Matrix<Scalar, rows, columns>,
               std::enable_if_t<(rows == Eigen::Dynamic) != (columns == Eigen::Dynamic)>> {
  using Matrix = Eigen::Matrix<Scalar, rows, columns>;

  static py::object toPython(Matrix matrix) { return toArray(std::move(matrix)); }
  static py::object check(const py::object& value, const std::string& name)
  {
    return checkedArray(value, name, py::dtype::of<Scalar>(), columns == 1 ? 1 : rows);
  }
  static void fill(Matrix& out, py::handle value, const std::string& name, Lender& lender)
  {
    lender.lend(out, check(py::reinterpret_borrow<py::object>(value), name));
  }
  static std::string annotation()
  {
    return std::is_same_v<Scalar, float>    ? "Floats"
           : std::is_same_v<Scalar, double> ? "Doubles"
           : std::is_same_v<Scalar, int>    ? "Ints"
                                            : "Bytes";
  }
};

/// Small matrices, vectors and motions: copies.
template <typename Small>
struct ConvertSmall {
  static constexpr int rows = Small::RowsAtCompileTime, columns = Small::ColsAtCompileTime;
  static py::object toPython(const Small& small) { return fromMatrix(small.matrix()); }
  static void fill(Small& out, py::handle value, const std::string& name, Lender&)
  {
    out = toMatrix(value, name, rows, columns);
  }
  static py::object check(const py::object& value, const std::string& name)
  {
    return fromMatrix(toMatrix(value, name, rows, columns));
  }
  static std::string annotation() { return "Doubles"; }
};
template <int rows, int columns>
struct Convert<Eigen::Matrix<double, rows, columns>, std::enable_if_t<(rows > 0 && columns > 0)>>
    : ConvertSmall<Eigen::Matrix<double, rows, columns>> {};
template <int rows>
struct Convert<Eigen::Array<double, rows, 1>> : ConvertSmall<Eigen::Array<double, rows, 1>> {};
template <>
struct Convert<Eigen::Isometry3d> : ConvertSmall<Eigen::Matrix4d> {
  static py::object toPython(const Eigen::Isometry3d& motion) { return fromMatrix(motion.matrix()); }
  static void fill(Eigen::Isometry3d& out, py::handle value, const std::string& name, Lender&)
  {
    out.matrix() = toMatrix(value, name, 4, 4);
  }
};

/// The class of a struct in Python; it is there once addRecord() has made it.
template <typename T>
py::handle& recordClass()
{
  static py::handle cls;
  return cls;
}
/// An object of a class, without its values.
py::object newRecord(py::handle cls);

template <typename T>
struct Convert<T, std::enable_if_t<has_fields<T>>> {
  static py::object toPython(T value)
  {
    py::object record = newRecord(recordClass<T>());
    Fields<T>::visit([&](const char* name, auto member, const char*) {
      const py::object entry = python::toPython(std::move(value.*member));
      if (PyObject_GenericSetAttr(record.ptr(), py::str(name).ptr(), entry.ptr()) != 0)
        throw py::error_already_set();
    });
    return record;
  }
  static py::object check(const py::object& value, const std::string& name)
  {
    if (!py::isinstance(value, recordClass<T>()))
      throwWrongType(name, value, Fields<T>::name);
    return value;
  }
  static void fill(T& out, py::handle value, const std::string& name, Lender& lender)
  {
    check(py::reinterpret_borrow<py::object>(value), name);
    Fields<T>::visit([&](const char* field, auto member, const char*) {
      using Member = std::decay_t<decltype(out.*member)>;
      Convert<Member>::fill(out.*member, py::getattr(value, field), name + "." + field, lender);
    });
  }
  static std::string annotation() { return Fields<T>::name; }
};

/// Whether an option is a number that nobody has chosen, None in Python.
template <typename T>
bool isUnset(const T& value)
{
  if constexpr (std::is_floating_point_v<T>)
    return std::isnan(value);
  return false;
}

/// A default as it is written in Python.
template <typename T>
std::string defaultText(const T& value)
{
  if (isUnset(value))
    return "None";
  if constexpr (std::is_same_v<T, float>) { // the shortest text that gives this float
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.begin(), text.end(), value).ptr;
    const std::string number(text.begin(), end);
    return number.find_first_not_of("-0123456789") == std::string::npos ? number + ".0" : number;
  } else {
    return py::repr(python::toPython(value));
  }
}
template <int rows>
std::string defaultText(const Eigen::Matrix<double, rows, 1>& vector)
{
  std::string text;
  for (const double value : vector)
    text += (text.empty() ? "(" : ", ") + defaultText(value);
  return text + ")";
}
} // namespace fresco::python
