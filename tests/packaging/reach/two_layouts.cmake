cmake_minimum_required(VERSION 3.25)

# Compiles PROGRAM by COMPILER with FLAGS in DIRECTORY twice, once with WITH besides, links both into one program in either order, and
# runs it: what it prints must be twice what is in PRINTS, what PROGRAM prints alone.
file(REMOVE_RECURSE ${DIRECTORY})
file(MAKE_DIRECTORY ${DIRECTORY})
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
string(REPLACE "|" ";-isystem;" includes "-I;${INCLUDES}")
set(compile ${COMPILER} ${flags} ${includes})
file(WRITE ${DIRECTORY}/both.cpp "int one();\nint two();\nint main() { return one() + two(); }\n")
execute_process(COMMAND ${compile} -Dmain=one -c ${PROGRAM} -o one.o WORKING_DIRECTORY ${DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${compile} -Dmain=two ${WITH} -c ${PROGRAM} -o two.o WORKING_DIRECTORY ${DIRECTORY}
                COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PRINTS} alone)
foreach(objects IN ITEMS "one.o;two.o" "two.o;one.o")
    execute_process(COMMAND ${COMPILER} both.cpp ${objects} -o both WORKING_DIRECTORY ${DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${DIRECTORY}/both RESULT_VARIABLE result OUTPUT_VARIABLE output)
    if(NOT result EQUAL 0 OR alone STREQUAL "" OR NOT output STREQUAL "${alone}${alone}")
        message(FATAL_ERROR "Linked as ${objects} it returns ${result} and does not print ${PRINTS} twice.")
    endif()
endforeach()
