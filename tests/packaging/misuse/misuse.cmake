cmake_minimum_required(VERSION 3.25)

# Compiles CASE as it stands, which must succeed, and with MISUSE defined, which must fail on a line of CASE itself. Without
# a CASE it compiles the header HEADERS, for those that follow.
string(REGEX REPLACE "([^|]+)" "-I\\1" flags "${INCLUDES}")
string(REPLACE "|" ";" flags "${flags}")
set(command ${COMPILER} -std=c++20 -Werror=unused-result ${flags})
if(NOT CASE)
    execute_process(COMMAND ${command} -x c++-header ${HEADERS} -o ${HEADERS}.gch COMMAND_ERROR_IS_FATAL ANY)
    return()
endif()
list(APPEND command -fsyntax-only -include ${HEADERS} ${CASE})

execute_process(COMMAND ${command} RESULT_VARIABLE result ERROR_VARIABLE messages)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "The correct twin does not compile:\n${messages}")
endif()

execute_process(COMMAND ${command} -DMISUSE RESULT_VARIABLE result ERROR_VARIABLE messages)
if(result EQUAL 0)
    message(FATAL_ERROR "The misuse compiles.")
endif()
cmake_path(GET CASE FILENAME name)
if(NOT messages MATCHES "${name}:[0-9]+:[0-9]+: error: ([^\n]*)")
    message(FATAL_ERROR "The misuse fails for another reason:\n${messages}")
endif()
message(STATUS "${CMAKE_MATCH_1}")
