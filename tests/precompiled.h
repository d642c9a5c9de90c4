#pragma once

// What most tests include.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/convex_hull.h"
#include "taut/verify/verify_hull.h"
