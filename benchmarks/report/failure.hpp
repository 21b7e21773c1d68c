#pragma once

#include <string>

namespace report {

// What stops the program: the one line that the user reads. Thrown before any output is in place.
struct Failure {
    std::string message;
};

}  // namespace report
