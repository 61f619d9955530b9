// SPDX-License-Identifier: MIT
// Names of the 80 classes of COCO in the order that detectors trained on it number them (0 person ... 79
// toothbrush).
#pragma once

#include <string>
#include <vector>

namespace atlas {

const std::vector<std::string>& cocoNames();
/// "car" for 2; "class 99" for a number without a name.
std::string className(int class_id);

}  // namespace atlas
