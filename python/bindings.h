#ifndef ELASTIMATE_PYTHON_BINDINGS_H_
#define ELASTIMATE_PYTHON_BINDINGS_H_

#include <pybind11/pybind11.h>

namespace elastimate {

// Each function adds a part of the module elastimate._core.  Results of one
// part are arguments of the next, so they are called in this order.

void BindScene(pybind11::module_& module);
void BindOptions(pybind11::module_& module);
void BindEstimate(pybind11::module_& module);
void BindLaws(pybind11::module_& module);

}  // namespace elastimate

#endif  // ELASTIMATE_PYTHON_BINDINGS_H_
