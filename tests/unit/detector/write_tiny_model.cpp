// SPDX-License-Identifier: MIT
// write_tiny_model FILE: the model of tiny_model.hpp, for the launch test of the detector.
#include <fstream>
#include <iostream>

#include "tiny_model.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_tiny_model FILE\n";
    return 2;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << atlas::tinyModel(atlas::Layout::kV8) << std::flush;
  return file ? 0 : 1;
}
