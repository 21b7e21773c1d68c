cmake_minimum_required(VERSION 3.25)

# Before C++20 by __cplusplus each public header of HEADERS ends the compilation by COMPILER with one line that says what to do,
# whatever stands below it; by MSVC's _MSVC_LANG, where it is there, one of them.
find_program(compiler ${COMPILER})
if(NOT compiler)
    message(STATUS "Skipped: no ${COMPILER}")
    return()
endif()
set(includes -isystem ${HEADERS} -isystem ${GLM})

file(GLOB headers RELATIVE ${HEADERS} ${HEADERS}/texgen/*.hpp)
if(NOT headers)
    message(FATAL_ERROR "no headers in ${HEADERS}")
endif()
foreach(header IN LISTS headers)
    set(languages -std=c++17)
    # After a fatal error clang++ reads on in silence: all of one header, of the others what the preprocessor sees.
    set(step -fsyntax-only)
    if(header STREQUAL "texgen/texgen.hpp")
        list(APPEND languages "-std=c++20 -D_MSVC_LANG=201703L")
    elseif(COMPILER MATCHES "clang")
        set(step -E)
    endif()
    string(MAKE_C_IDENTIFIER ${header} name)
    set(file ${DIRECTORY}/${name}.cpp)
    file(WRITE ${file} "#include <${header}>\nconst auto region = texgen::whole_texture();\n")
    foreach(language IN LISTS languages)
        separate_arguments(flags UNIX_COMMAND "${language}")
        execute_process(COMMAND ${compiler} ${flags} ${includes} ${step} ${file}
                        RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE messages)
        string(REGEX MATCHALL "(error|warning):[^\n]*" complaints "${messages}")
        list(LENGTH complaints count)
        if(result EQUAL 0 OR NOT count EQUAL 1 OR NOT complaints MATCHES "texgen needs C[+][+]20: compile with -std=c[+][+]20")
            string(SUBSTRING "${messages}" 0 2000 messages)
            message(FATAL_ERROR "${header}, ${language}, ${count} complaints:\n${messages}")
        endif()
    endforeach()
endforeach()

# MSVC's __cplusplus says C++98 unless it is told otherwise.
file(WRITE ${DIRECTORY}/msvc.cpp "#undef __cplusplus\n#define __cplusplus 199711L\n#include <texgen/detail/language.hpp>\n")
execute_process(COMMAND ${compiler} -w -D_MSVC_LANG=202002L ${includes} -E ${DIRECTORY}/msvc.cpp
                OUTPUT_QUIET ERROR_VARIABLE messages)
if(messages MATCHES "texgen needs")
    message(FATAL_ERROR "MSVC's C++20 is refused:\n${messages}")
endif()
