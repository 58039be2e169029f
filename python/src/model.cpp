// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
void addModel(const py::module_& module)
{
  addRecord<ModelReport>(module);
  addRecord<ModelStage>(module);
  addFunction<ModelOptions>(module,
                            {"build_model",
                             "buildModel",
                             {{"input_folder", "Path"}, {"output_folder", "Path"}},
                             "ModelReport",
                             "One model is built at a time: a second thread waits."},
                            [](const Call& call) {
                              const auto input = call.value<std::string>("input_folder"),
                                         output = call.value<std::string>("output_folder");
                              const auto options = call.options<ModelOptions>();
                              return call.run([&](const Progress& progress) {
                                const std::lock_guard<std::mutex> lock(oneAtATime());
                                return buildModel(input, output, options, progress);
                              });
                            });
  addFunction(module, {"describe_input", "describeInput", {{"input_folder", "Path"}}, "str", "", false},
              [](const Call& call) {
                const auto input = call.value<std::string>("input_folder");
                return toPython(Call::access([&] { return describeInput(input); }));
              });
}
} // namespace fresco::python
