#ifndef ELASTIMATE_IO_VTK_VTK_MESSAGES_H_
#define ELASTIMATE_IO_VTK_VTK_MESSAGES_H_

#include <vtkSmartPointer.h>

#include <mutex>
#include <string>

class vtkOutputWindow;

namespace elastimate {

class VtkMessageWindow;

/// While it lives, what VTK reports in this thread is kept here instead of
/// being printed.  VTK's output window and log are global: another thread that
/// makes such an object waits until this one has gone, and what VTK reports in
/// a thread that makes none goes where it went before.
class VtkMessages {
 public:
  enum class Warnings { kIgnored, kAreErrors };

  explicit VtkMessages(Warnings warnings);
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  bool HasError() const;

  /// Returns the first error as one line, without VTK's source file and object
  /// address.
  std::string FirstError() const;

 private:
  std::unique_lock<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> previous_window_;
  vtkSmartPointer<VtkMessageWindow> window_;
  int previous_display_;
  int previous_verbosity_;
};

}  // namespace elastimate

#endif  // ELASTIMATE_IO_VTK_VTK_MESSAGES_H_
