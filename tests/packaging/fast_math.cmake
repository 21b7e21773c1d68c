cmake_minimum_required(VERSION 3.25)

# FLAGS let the compiler reorder arithmetic: the library must refuse them with a message that says what to do, and compile
# where that is done.
string(REGEX REPLACE "([^|]+)" "-I\\1" includes "${INCLUDES}")
string(REPLACE "|" ";" includes "${includes}")
foreach(header IN ITEMS texgen transform)
    file(WRITE ${DIRECTORY}/${header}.cpp "#include <texgen/${header}.hpp>\n")
    set(command ${COMPILER} -std=c++20 -fsyntax-only ${includes} ${FLAGS})
    execute_process(COMMAND ${command} ${DIRECTORY}/${header}.cpp RESULT_VARIABLE result ERROR_VARIABLE messages)
    if(result EQUAL 0)
        message(FATAL_ERROR "${header}.hpp compiles with ${FLAGS}.")
    endif()
    if(NOT messages MATCHES "compile the files that include it with -fno-fast-math")
        message(FATAL_ERROR "${header}.hpp does not say what to do:\n${messages}")
    endif()
    execute_process(COMMAND ${command} -fno-fast-math ${DIRECTORY}/${header}.cpp
                    RESULT_VARIABLE result ERROR_VARIABLE messages)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${header}.hpp does not compile as it says:\n${messages}")
    endif()
endforeach()
