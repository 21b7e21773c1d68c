# Sets milliseconds_<unit> to the processor time of compiling DIRECTORY/<unit>.cpp by COMPILER with the flags that follow:
# the least of several runs, in which the units take turns, so that a busy machine changes little. A unit has its last run
# after `most_runs`, or once `enough_milliseconds` went into it. Sets failure to why it could not, else to nothing.
function(measure_compilations units most_runs enough_milliseconds)
    set(failure "" PARENT_SCOPE)
    foreach(unit IN LISTS units)
        set(spent_${unit} 0)
    endforeach()
    foreach(run RANGE 1 ${most_runs})
        foreach(unit IN LISTS units)
            if(spent_${unit} GREATER_EQUAL enough_milliseconds)
                continue()
            endif()
            execute_process(
                COMMAND bash -c "TIMEFORMAT='%3U %3S'; time \"$@\"" bash ${COMPILER} ${ARGN} ${unit}.cpp
                WORKING_DIRECTORY ${DIRECTORY} RESULT_VARIABLE result ERROR_VARIABLE times)
            if(NOT result EQUAL 0 OR NOT times MATCHES "([0-9]+)[.,](...) ([0-9]+)[.,](...)\n$")
                set(failure "${result}: ${times}" PARENT_SCOPE)
                return()
            endif()
            math(EXPR milliseconds
                 "1000 * (${CMAKE_MATCH_1} + ${CMAKE_MATCH_3}) + 1${CMAKE_MATCH_2} + 1${CMAKE_MATCH_4} - 2000")
            math(EXPR spent_${unit} "${spent_${unit}} + ${milliseconds}")
            if(NOT DEFINED milliseconds_${unit} OR milliseconds LESS milliseconds_${unit})
                set(milliseconds_${unit} ${milliseconds})
            endif()
        endforeach()
    endforeach()
    foreach(unit IN LISTS units)
        set(milliseconds_${unit} ${milliseconds_${unit}} PARENT_SCOPE)
    endforeach()
endfunction()

# What users of GLM include anyway: the cost of texgen's headers is measured against it.
set(glm_headers "#include <glm/mat4x4.hpp>\n#include <glm/vec2.hpp>\n#include <glm/vec3.hpp>\n#include <glm/vec4.hpp>\n")
