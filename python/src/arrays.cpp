// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.h"
#include <fresco/core/require.h>
namespace fresco::python {
namespace {
std::string typeName(py::handle value) { return py::str(py::type::of(value).attr("__name__")); }

/// numpy.asarray(), which copies no array and nothing that shows itself as one.
py::array asArray(py::handle value, const std::string& name)
{
  if (py::isinstance<py::array>(value)) // also of a class of its own, such as numpy.memmap
    return py::reinterpret_borrow<py::array>(value);
  const auto array = py::array::ensure(py::reinterpret_borrow<py::object>(value));
  if (!array) {
    PyErr_Clear();
    throw py::type_error(concat(name, ": ", typeName(value), " is no array"));
  }
  return array;
}

std::string shapeText(const py::array& array) { return py::str(array.attr("shape")); }

/// `array` in that type, C order and memory that can be written: itself where it is so, or a copy.
py::array fittingArray(const py::array& array, const std::string& name, const py::dtype& type)
{
  const py::module_ numpy = py::module_::import("numpy");
  const char given = array.dtype().kind(), wanted = type.kind();
  py::object values = array;
  if (!array.dtype().equal(type)) {
    const bool fraction = wanted == 'u' && given == 'f'; // colours of 0..1
    const bool number = given == 'i' || given == 'u' || given == 'f';
    if (!number || (wanted == 'i' && given == 'f'))
      throw py::type_error(concat(name, ": of type ", std::string(py::str(py::handle(array.dtype()))), ", wanted ",
                                  std::string(py::str(py::handle(type)))));
    if (wanted != 'f' && array.size() > 0) {
      constexpr double slack = 1e-3; // rounded away
      const py::object limits = numpy.attr("iinfo")(type);
      const py::object least = fraction ? py::object(py::float_(-slack)) : py::object(limits.attr("min"));
      const py::object most = fraction ? py::object(py::float_(1 + slack)) : py::object(limits.attr("max"));
      const bool fits = values.attr("min")() >= least && values.attr("max")() <= most;
      if (!fits)
        throw py::value_error(
            concat(name, ": from ", std::string(py::str(values.attr("min")())), " to ",
                   std::string(py::str(values.attr("max")())), ", wanted ",
                   fraction ? "0 to 1" : std::string(py::str(least)) + " to " + std::string(py::str(most))));
    }
    if (fraction)
      values = numpy.attr("rint")(values.attr("__mul__")(255));
  }
  return numpy.attr("require")(values, type, py::make_tuple("C", "W"));
}
} // namespace

Lender::~Lender()
{
  for (const auto& give_back : returns_)
    give_back();
}

py::array checkedArray(py::handle value, const std::string& name, const py::dtype& type, Index width)
{
  const py::array none(type, width > 1 ? std::vector<py::ssize_t>{0, width} : std::vector<py::ssize_t>{0});
  if (value.is_none())
    return none;
  const py::array array = asArray(value, name);
  if (array.size() == 0 && array.ndim() == 1) // []
    return none;
  const bool fits = width > 1 ? array.ndim() == 2 && array.shape(1) == width : array.ndim() == 1;
  if (array.dtype().kind() != 'U' && array.dtype().kind() != 'O' && !fits)
    throw py::value_error(
        concat(name, ": of shape ", shapeText(array), ", wanted ", width > 1 ? concat("(N, ", width, ")") : "(N,)"));
  return fittingArray(array, name, type);
}

py::array toArray(std::vector<Index>&& values)
{
  auto owned = std::make_unique<std::vector<Index>>(std::move(values));
  const std::size_t count = owned->size();
  const Index* const data = owned->data();
  const py::capsule owner(owned.release(), [](void* kept) { delete static_cast<std::vector<Index>*>(kept); });
  return py::array(py::dtype::of<Index>(), {count}, {sizeof(Index)}, data, owner);
}

py::array toArray(Image&& image)
{
  std::vector<py::ssize_t> shape{image.height, image.width};
  if (image.channels > 1)
    shape.push_back(image.channels);
  auto owned = std::make_unique<std::vector<std::uint8_t>>(std::move(image.data));
  const std::uint8_t* const data = owned->data();
  const py::capsule owner(owned.release(), [](void* kept) { delete static_cast<std::vector<std::uint8_t>*>(kept); });
  return py::array(py::dtype::of<std::uint8_t>(), std::move(shape), data, owner);
}

Image toImage(py::handle value, const std::string& name)
{
  if (value.is_none())
    return {};
  const py::array array = asArray(value, name);
  if (!array.dtype().equal(py::dtype::of<std::uint8_t>()))
    throw py::type_error(concat(name, ": of type ", std::string(py::str(py::handle(array.dtype()))), ", wanted uint8"));
  const Index channels = array.ndim() == 2 ? 1 : array.ndim() == 3 ? array.shape(2) : 0;
  if (channels != 1 && channels != 3 && channels != 4)
    throw py::value_error(concat(name, ": of shape ", shapeText(array), ", wanted (height, width, 1, 3 or 4)"));
  const auto rows = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>::ensure(array);
  Image image;
  image.width = static_cast<int>(array.shape(1));
  image.height = static_cast<int>(array.shape(0));
  image.channels = static_cast<int>(channels);
  image.data.assign(rows.data(), rows.data() + rows.size());
  return image;
}

Eigen::MatrixXd toMatrix(py::handle value, const std::string& name, Index rows, Index columns)
{
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(concat(name, ": ", typeName(value), " holds no numbers"));
  }
  const bool fits = columns > 1 ? array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == columns
                                : array.ndim() == 1 && array.shape(0) == rows;
  if (!fits)
    throw py::value_error(concat(name, ": of shape ", shapeText(array), ", wanted (", rows,
                                 columns > 1 ? concat(", ", columns, ")") : ",)"));
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(array.data(), rows,
                                                                                                  columns);
}

py::array fromMatrix(const Eigen::MatrixXd& matrix)
{
  std::vector<py::ssize_t> shape{matrix.rows()};
  if (matrix.cols() > 1)
    shape.push_back(matrix.cols());
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return py::array_t<double>(std::move(shape), rows.data()); // a copy
}
} // namespace fresco::python
