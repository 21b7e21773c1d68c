# Whether the compiler finds the standard library that its flags name: a package of its own, which may not be there.
function(find_standard_library result compiler flags)
    separate_arguments(arguments UNIX_COMMAND "${flags}")
    execute_process(COMMAND ${CMAKE_COMMAND} -E echo "#include <array>"
                    COMMAND ${compiler} ${arguments} -fsyntax-only -x c++ -
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed)
        set(${result} FALSE PARENT_SCOPE)
    else()
        set(${result} TRUE PARENT_SCOPE)
    endif()
endfunction()
