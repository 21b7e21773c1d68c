cmake_minimum_required(VERSION 3.25)

# What a call of interpolate() of a triangle adds to a program, the kernels of all instruction sets included. 19 kB of it decide
# what is in doubt, in vectors and about the tile, so that no triangle costs many times the ordinary one.
set(allowed_bytes 63744)

find_program(size size)
execute_process(COMMAND ${COMPILER} --version OUTPUT_VARIABLE version)
if(NOT size OR NOT version MATCHES "Free Software Foundation")
    message(STATUS "Skipped: it is promised of g++'s code, which `size` counts")
    return()
endif()
string(REGEX REPLACE "([^|]+)" "-I\\1" flags "${INCLUDES}")
string(REPLACE "|" ";" flags "${flags}")
file(WRITE ${DIRECTORY}/call.cpp "#include <texgen/interpolate.hpp>\nusing namespace texgen;\n"
    "Work call(const TriangleSetup& setup, FragmentRect rect, Texcoords out) { return interpolate(setup, rect, out); }\n")
execute_process(COMMAND ${COMPILER} -std=c++20 -O2 -DNDEBUG -c ${flags} call.cpp -o call.o
    WORKING_DIRECTORY ${DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${size} -A call.o WORKING_DIRECTORY ${DIRECTORY} OUTPUT_VARIABLE sections
    COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n\\.text[^ ]* +[0-9]+" sections "${sections}")
list(TRANSFORM sections REPLACE ".* " "")
list(JOIN sections " + " sum)
math(EXPR bytes "${sum}")
message(STATUS "${bytes} bytes of code")
if(bytes GREATER allowed_bytes)
    message(FATAL_ERROR "A call of interpolate() adds more than ${allowed_bytes} bytes.")
endif()
