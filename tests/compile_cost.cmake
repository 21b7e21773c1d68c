cmake_minimum_required(VERSION 3.25)

# Compares what it costs to compile texgen's umbrella header with what the GLM headers cost that its users have anyway:
# processor time, the least of several interleaved runs each, so that a busy machine changes little.
set(allowed_ratio 3)
set(rounds 7)

string(REGEX REPLACE "([^|]+)" "-I\\1" flags "${INCLUDES}")
string(REPLACE "|" ";" flags "${flags}")
file(WRITE ${DIRECTORY}/glm.cpp
    "#include <glm/mat4x4.hpp>\n#include <glm/vec2.hpp>\n#include <glm/vec3.hpp>\n#include <glm/vec4.hpp>\n")
file(WRITE ${DIRECTORY}/texgen.cpp "#include <texgen/texgen.hpp>\n")

foreach(round RANGE 1 ${rounds})
    foreach(unit IN ITEMS glm texgen)
        execute_process(
            COMMAND bash -c "TIMEFORMAT='%3U %3S'; time \"$@\"" bash
                    ${COMPILER} -std=c++20 -O2 -fsyntax-only ${flags} ${DIRECTORY}/${unit}.cpp
            RESULT_VARIABLE result ERROR_VARIABLE times)
        if(NOT result EQUAL 0 OR NOT times MATCHES "([0-9]+)[.,](...) ([0-9]+)[.,](...)\n$")
            message(FATAL_ERROR "${times}")
        endif()
        math(EXPR milliseconds
             "1000 * (${CMAKE_MATCH_1} + ${CMAKE_MATCH_3}) + 1${CMAKE_MATCH_2} + 1${CMAKE_MATCH_4} - 2000")
        if(NOT DEFINED least_${unit} OR milliseconds LESS least_${unit})
            set(least_${unit} ${milliseconds})
        endif()
    endforeach()
endforeach()

math(EXPR percent "100 * ${least_texgen} / ${least_glm}")
math(EXPR limit "${allowed_ratio} * ${least_glm}")
message(STATUS "GLM ${least_glm} ms, texgen ${least_texgen} ms: ${percent} %")
if(least_texgen GREATER limit)
    message(FATAL_ERROR "texgen/texgen.hpp costs more than ${allowed_ratio} times GLM's own headers.")
endif()
