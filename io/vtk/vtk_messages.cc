#include "elastimate/io/vtk/vtk_messages.h"

#include <vtkLogger.h>
#include <vtkObject.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <algorithm>
#include <cstring>
#include <thread>

#include "elastimate/io/text/printable.h"

namespace elastimate {
namespace {

constexpr std::size_t kLongestVtkMessage = 240;  // Which may quote the file.

std::mutex& TheMutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

class VtkMessageWindow : public vtkOutputWindow {
 public:
  static VtkMessageWindow* New();

  void DisplayText(const char* text) override {
    if (!IsOwnThread()) {
      others_->DisplayText(text);
    }
  }
  void DisplayDebugText(const char* text) override {
    if (!IsOwnThread()) {
      others_->DisplayDebugText(text);
    }
  }
  void DisplayWarningText(const char* text) override {
    if (!IsOwnThread()) {
      others_->DisplayWarningText(text);
    } else if (warnings_are_errors_) {
      NoteError(text);
    }
  }
  void DisplayGenericWarningText(const char* text) override {
    if (!IsOwnThread()) {
      others_->DisplayGenericWarningText(text);
    } else if (warnings_are_errors_) {
      NoteError(text);
    }
  }
  void DisplayErrorText(const char* text) override {
    if (!IsOwnThread()) {
      others_->DisplayErrorText(text);
    } else {
      NoteError(text);
    }
  }

  bool IsOwnThread() const { return std::this_thread::get_id() == thread_; }

  void NoteError(const char* text) {
    // This complaint is about what is noted beside an array, not about its
    // data: VTK cannot read the infinite ranges that it writes there, nor keys
    // of other versions.
    if (text != nullptr &&
        (std::strstr(text, "InformationKey") != nullptr ||
         std::strstr(text, "Could not locate key") != nullptr)) {
      return;
    }
    has_error_ = true;
    if (first_error_.empty() && text != nullptr) {
      first_error_ = text;
    }
  }

  const std::thread::id thread_ = std::this_thread::get_id();
  vtkSmartPointer<vtkOutputWindow> others_;  ///< For other threads.
  bool warnings_are_errors_ = false;
  bool has_error_ = false;
  std::string first_error_;

 protected:
  VtkMessageWindow() = default;
  ~VtkMessageWindow() override = default;
  VtkMessageWindow(const VtkMessageWindow&) = delete;
  VtkMessageWindow& operator=(const VtkMessageWindow&) = delete;
};

vtkStandardNewMacro(VtkMessageWindow);

VtkMessages::VtkMessages(Warnings warnings)
    : lock_(TheMutex()),
      previous_window_(vtkOutputWindow::GetInstance()),
      window_(vtkSmartPointer<VtkMessageWindow>::New()),
      previous_display_(vtkObject::GetGlobalWarningDisplay()),
      previous_verbosity_(std::min<int>(vtkLogger::GetCurrentVerbosityCutoff(),
                                        vtkLogger::VERBOSITY_INFO)) {
  window_->others_ = previous_window_;
  window_->warnings_are_errors_ = warnings == Warnings::kAreErrors;
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkOutputWindow::SetInstance(window_);
  // Switched off, VTK would not even tell that something failed.
  vtkObject::GlobalWarningDisplayOn();
}

VtkMessages::~VtkMessages() {
  vtkOutputWindow::SetInstance(previous_window_);
  vtkObject::SetGlobalWarningDisplay(previous_display_);
  vtkLogger::SetStderrVerbosity(
      static_cast<vtkLogger::Verbosity>(previous_verbosity_));
}

bool VtkMessages::HasError() const { return window_->has_error_; }

std::string VtkMessages::FirstError() const {
  // "ERROR: In FILE, line N\nCLASS (ADDRESS): MESSAGE\n\n", or "Warning: ..."
  std::string message = window_->first_error_;
  if (const auto line_end = message.find('\n');
      message.find(": In ") < line_end && line_end != std::string::npos) {
    message.erase(0, line_end + 1);
  }
  if (const auto address_end = message.find("): ");
      address_end != std::string::npos) {
    message.erase(0, address_end + 3);
  }
  message.erase(message.find_last_not_of(" .\n") + 1);
  for (char& c : message) {
    c = c == '\n' ? ' ' : c;
  }
  return Printable(message, kLongestVtkMessage);
}

}  // namespace elastimate
