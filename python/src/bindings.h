// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <pybind11/pybind11.h>
/// What each file of bindings adds to the module.
namespace fresco::python {
void addCore(const pybind11::module_& module);
void addIo(const pybind11::module_& module);
void addFilters(const pybind11::module_& module);
void addRegistration(const pybind11::module_& module);
void addPoses(const pybind11::module_& module);
void addSurface(const pybind11::module_& module);
void addQueries(const pybind11::module_& module);
void addTexture(const pybind11::module_& module);
void addPlans(const pybind11::module_& module);
void addDeliverables(const pybind11::module_& module);
void addModel(const pybind11::module_& module);
void addRendering(const pybind11::module_& module);
} // namespace fresco::python
