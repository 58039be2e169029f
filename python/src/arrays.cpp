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
} // namespace

Lender::~Lender()
{
  for (const auto& give_back : returns_)
    give_back();
}

py::array checkedArray(py::handle value, const std::string& name, const py::dtype& type, Index width)
{
  if (value.is_none())
    return py::array(type, width > 1 ? std::vector<py::ssize_t>{0, width} : std::vector<py::ssize_t>{0});
  const py::array array = asArray(value, name);
  if (!array.dtype().equal(type)) {
    const std::string wanted = py::str(py::handle(type));
    throw py::type_error(concat(name, ": of type ", std::string(py::str(py::handle(array.dtype()))), ", wanted ",
                                wanted, ": numpy.asarray(", name, ", numpy.", wanted, ")"));
  }
  const bool fits = width > 1 ? array.ndim() == 2 && array.shape(1) == width : array.ndim() == 1;
  if (!fits)
    throw py::value_error(
        concat(name, ": of shape ", shapeText(array), ", wanted ", width > 1 ? concat("(N, ", width, ")") : "(N,)"));
  if ((array.flags() & py::array::c_style) == 0)
    throw py::value_error(concat(name, ": not contiguous: numpy.ascontiguousarray(", name, ")"));
  return array;
}

py::array sharedArray(const py::array& array, const std::string& name)
{
  if (array.size() > 0 && !array.writeable())
    throw py::value_error(concat(name, ": read-only: numpy.array(", name, ") is a copy that can be written"));
  return array;
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
