// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
namespace {
/// Raises fresco.NAME with a message that may hold names of files.
void raise(py::handle type, const char* message) { PyErr_SetObject(type.ptr(), toText(message).ptr()); }

py::handle errorClass(const char* name)
{
  return py::module_::import("fresco._base").attr(name).cast<py::object>().release(); // for as long as the process
}

void translate(std::exception_ptr thrown)
{
  static const py::handle error = errorClass("Error"), cancelled = errorClass("Cancelled"),
                          trouble = errorClass("FileError");
  try {
    if (thrown)
      std::rethrow_exception(std::move(thrown));
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const Cancelled& e) {
    raise(cancelled, e.what());
  } catch (const FileTrouble& e) {
    raise(trouble, e.what());
  } catch (const std::invalid_argument& e) {
    raise(PyExc_ValueError, e.what());
  } catch (const std::runtime_error& e) {
    raise(error, e.what());
  }
}

/// The stubs of the module, _fresco.pyi.
std::string stubText()
{
  return "# Made from the module by write_stubs.py.\n"
         "import os\n"
         "from collections.abc import Callable, Sequence\n"
         "from typing import Any, Literal, Optional, Union\n\n"
         "import numpy as np\n"
         "from numpy.typing import ArrayLike, NDArray\n\n"
         "from ._base import Record\n"
         "from ._geometry import FloorPlanBase, PointSetBase, TexturedMeshBase, TriangleMeshBase\n\n"
         "Floats = NDArray[np.float32]\nDoubles = NDArray[np.float64]\nInts = NDArray[np.int32]\n"
         "Indices = NDArray[np.int64]\nBytes = NDArray[np.uint8]\n"
         "Path = Union[str, bytes, os.PathLike[Any]]\nProgress = Callable[[str, float], Any]\n\n"
         "__version__: str\n\n" +
         stubs();
}

/// Where the arrays of a set begin for the core: no copies are made on the way.
py::dict addresses(const py::object& set)
{
  const Lent<PointSet> lent(set, "points");
  py::dict found;
  Fields<PointSet>::visit([&](const char* name, auto member, const char*) {
    found[name] = reinterpret_cast<std::uintptr_t>(((*lent).*member).data());
  });
  return found;
}
} // namespace
} // namespace fresco::python

PYBIND11_MODULE(_fresco, module)
{
  using namespace fresco::python;
  module.doc() = "The compiled part of fresco.";
  py::register_local_exception_translator(translate);
  watchEndOfPython();
  addCore(module);
  addIo(module);
  addFilters(module);
  addRegistration(module);
  addPoses(module);
  addSurface(module);
  addQueries(module);
  addTexture(module);
  addDeliverables(module);
  addPlans(module);
  addModel(module);
  addRendering(module);
  module.attr("__version__") = FRESCO_VERSION;
  module.def("_stubs", stubText);
  module.def("_addresses", addresses);
}
