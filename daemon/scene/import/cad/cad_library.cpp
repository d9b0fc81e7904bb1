// SPDX-License-Identifier: MIT
#include "daemon/scene/import/cad/cad_library.h"

#include <new>
#include <stdexcept>
#include <string>

#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>

namespace camway::scene::cad {

void start_cad() {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Controller::Init();
  IGESControl_Controller::Init();
  // Else B-splines that are not smooth are replaced by such as are near them.
  Interface_Static::SetIVal("read.iges.bspline.continuity", 0);
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
}

void with_cad_errors(const std::function<void()>& work) {
  try {
    work();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    const char* const message = failure.GetMessageString();
    const bool says_something = message != nullptr && *message != '\0';
    throw std::runtime_error(std::string("Open CASCADE failed: ") +
                             (says_something ? message : failure.DynamicType()->Name()));
  }
}

}  // namespace camway::scene::cad
