#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace nextview {

/// One thing a run needs of the machine.
struct Finding {
  std::string what;  ///< in a word or two
  bool good = false;
  std::string detail;  ///< what was found; where it is not good also what to type
};

/// Looks at everything a run needs of this machine: programs of one version, the recorder, whether
/// it can have a network of its own, the multicast route outside of one, a free port, socket
/// buffers, open files, the folder for what is kept. Takes up to 1.5 s where multicast does not
/// come back.
/// @param cache as --cache has it
std::vector<Finding> examine_machine(const std::string& cache);

/// A line a finding.
/// @return whether all are good
bool show_findings(std::ostream& to, const std::vector<Finding>& findings);

}  // namespace nextview
