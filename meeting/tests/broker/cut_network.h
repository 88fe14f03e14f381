// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace telemime::meeting::test_support {

/// Two computers and the cable between them: network namespaces of the kernel. The thread that makes it, and
/// what it starts from then on, is at the broker's until this ends. Needs root.
class CutNetwork {
 public:
  /// Why there can be none here, in words; empty when there can.
  static std::string missing();

  CutNetwork();
  CutNetwork(const CutNetwork&) = delete;
  CutNetwork& operator=(const CutNetwork&) = delete;
  ~CutNetwork();

  /// The broker's address, as the tracker sees it.
  static std::string broker() { return "10.77.0.1"; }
  /// Before the words of a command that is to run at the tracker's.
  std::vector<std::string> at_tracker() const;
  /// From now on nothing that one of them sends arrives; neither is told.
  void cut();
  void mend();

 private:
  std::string broker_;
  std::string tracker_;
  int home_ = -1;  ///< the namespace that the thread came from
};

}  // namespace telemime::meeting::test_support
