// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace telemime::meeting::test_support {

/// Two computers and a cable between them, as network namespaces. The thread that creates it, and what it
/// starts afterwards, is on the broker's computer until this object ends. Needs root.
class CutNetwork {
 public:
  /// Why this is not possible here; empty when it is.
  static std::string missing();

  CutNetwork();
  CutNetwork(const CutNetwork&) = delete;
  CutNetwork& operator=(const CutNetwork&) = delete;
  ~CutNetwork();

  /// The address of the broker for the tracker.
  static std::string broker() { return "10.77.0.1"; }
  /// Prefix of a command that is to run on the tracker's computer.
  std::vector<std::string> at_tracker() const;
  /// From now on no packet arrives, and neither side is notified.
  void cut();
  void mend();

 private:
  std::string broker_;
  std::string tracker_;
  int home_ = -1;  ///< the namespace that the thread came from
};

}  // namespace telemime::meeting::test_support
