// SPDX-License-Identifier: MIT
#pragma once

#include "atlas/base/avx2_clones.hpp"
