cmake_minimum_required(VERSION 3.25)

# Builds and runs the project beside this file in DIRECTORY, with texgen from SOURCE by the WAY:
#   subdirectory      add_subdirectory()
#   subdirectory_glm  the same where the system has no GLM: it is fetched (here OTHER_GLM or a stand-in, offline)
#   package           find_package() after an installation that was moved
#   fetched           FetchContent from a repository, where no package is installed
#   fetched_package   the same project where one is: nothing is fetched
#   pkg-config        the compiler alone, with the flags of pkg-config
#   copy              the compiler alone, with a copy of include/
#   engine            add_subdirectory() into a unity build, with a precompiled header, hidden symbols, an assertion
#   header_unit       import, where the compiler can
#   single_header     the compiler alone, with the generated header
# Nothing but GLM can be found meanwhile.
function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(run_for result)
    execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    set(${result} "${output}" PARENT_SCOPE)
endfunction()

set(settings --no-warn-unused-cli -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
foreach(package IN ITEMS Eigen3 doctest benchmark)
    list(APPEND settings -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
file(REMOVE_RECURSE ${DIRECTORY})

# Installed without a build, and moved.
function(install_to prefix)
    run(${CMAKE_COMMAND} -S ${SOURCE} -B ${DIRECTORY}/texgen ${settings} -DBUILD_TESTING=OFF)
    run(${CMAKE_COMMAND} --install ${DIRECTORY}/texgen --prefix ${DIRECTORY}/first)
    file(RENAME ${DIRECTORY}/first ${prefix})

    file(GLOB_RECURSE expected RELATIVE ${SOURCE} ${SOURCE}/include/texgen/*)
    list(APPEND expected share/pkgconfig/texgen.pc share/licenses/texgen/LICENSE)
    foreach(name IN ITEMS texgen-config texgen-config-version texgen-targets)
        list(APPEND expected share/cmake/texgen/${name}.cmake)
    endforeach()
    file(GLOB_RECURSE installed RELATIVE ${prefix} ${prefix}/*)
    list(SORT expected)
    list(SORT installed)
    if(NOT installed STREQUAL expected)
        message(FATAL_ERROR "installed: ${installed}\nexpected: ${expected}")
    endif()
endfunction()

# The project, by CMake.
function(build_project)
    run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${DIRECTORY}/build ${settings} ${ARGN})
    run(${CMAKE_COMMAND} --build ${DIRECTORY}/build)
    run(${DIRECTORY}/build/consumer)
endfunction()

# Programs by the compiler alone.
function(compile program)
    run(${COMPILER} -std=c++20 -Wall -Wextra -Wpedantic -Werror ${ARGN} -o ${DIRECTORY}/${program})
    run(${DIRECTORY}/${program})
endfunction()
set(without -fno-exceptions -fno-rtti)
set(main ${CMAKE_CURRENT_LIST_DIR}/main.cpp)

if(WAY STREQUAL subdirectory)
    build_project(-DSUBDIRECTORY=${SOURCE})

elseif(WAY STREQUAL engine)
    build_project(-DSUBDIRECTORY=${SOURCE} -DENGINE=ON -DTWO_UNITS=${SOURCE}/tests/packaging/two_units)
    foreach(program IN ITEMS unity unity_kernels precompiled hidden own_assert)
        message(STATUS ${program})
        run(${DIRECTORY}/build/${program})
    endforeach()
    # What the shared library shows: one function, and nothing of the library.
    find_program(nm NAMES nm REQUIRED)
    run_for(symbols ${nm} --dynamic --defined-only --demangle ${DIRECTORY}/build/libtwo.so)
    if(NOT symbols MATCHES "numbers_of_two" OR symbols MATCHES "texgen::")
        message(FATAL_ERROR "the shared library shows\n${symbols}")
    endif()

elseif(WAY STREQUAL header_unit)
    # Of Debian 12's compilers g++ alone knows header units; of the umbrella it writes one that it cannot read.
    execute_process(COMMAND ${COMPILER} --version OUTPUT_VARIABLE version)
    if(NOT version MATCHES "Free Software Foundation")
        message(STATUS "Skipped: this compiler has no header units")
        return()
    endif()
    file(MAKE_DIRECTORY ${DIRECTORY})
    set(modules -std=c++20 -fmodules-ts ${without} -I ${SOURCE}/include)
    run(${COMPILER} ${modules} -x c++-system-header texgen/linear.hpp WORKING_DIRECTORY ${DIRECTORY})
    run(${COMPILER} ${modules} ${CMAKE_CURRENT_LIST_DIR}/header_unit.cpp -o header_unit
        WORKING_DIRECTORY ${DIRECTORY})
    run(${DIRECTORY}/header_unit)

elseif(WAY STREQUAL subdirectory_glm)
    set(glm ${OTHER_GLM})
    if(NOT glm)
        set(glm ${DIRECTORY}/glm)
        file(WRITE ${glm}/CMakeLists.txt
            "add_library(glm INTERFACE)\nadd_library(glm::glm-header-only ALIAS glm)\n")
    endif()
    build_project(-DSUBDIRECTORY=${SOURCE} -DFETCHCONTENT_SOURCE_DIR_GLM=${glm})

elseif(WAY STREQUAL package)
    install_to(${DIRECTORY}/prefix)
    build_project(-DVERSION=${VERSION} -DCMAKE_PREFIX_PATH=${DIRECTORY}/prefix)

elseif(WAY MATCHES "^fetched")
    find_program(git git)
    if(NOT git)
        message(STATUS "Skipped: no git")
        return()
    endif()
    # The repository's address leads to a copy on this machine, and nowhere else.
    set(address https://texgen.invalid/texgen.git)
    file(COPY ${SOURCE}/CMakeLists.txt ${SOURCE}/LICENSE ${SOURCE}/include DESTINATION ${DIRECTORY}/mirror)
    run(${git} -C ${DIRECTORY}/mirror init --quiet)
    run(${git} -C ${DIRECTORY}/mirror add .)
    run(${git} -C ${DIRECTORY}/mirror -c user.name=texgen -c user.email=texgen@texgen.invalid
        -c commit.gpgsign=false commit --quiet -m "As it is")
    run_for(commit ${git} -C ${DIRECTORY}/mirror rev-parse HEAD)
    set(ENV{GIT_CONFIG_COUNT} 1)
    set(ENV{GIT_CONFIG_KEY_0} url.file://${DIRECTORY}/mirror.insteadOf)
    set(ENV{GIT_CONFIG_VALUE_0} ${address})
    if(WAY STREQUAL fetched_package)
        install_to(${DIRECTORY}/prefix)
        file(REMOVE_RECURSE ${DIRECTORY}/mirror)
        list(APPEND settings -DCMAKE_PREFIX_PATH=${DIRECTORY}/prefix)
    endif()
    build_project(-DVERSION=${VERSION} -DREPOSITORY=${address} -DCOMMIT=${commit})

elseif(WAY STREQUAL pkg-config)
    find_program(pkg_config NAMES pkg-config pkgconf)
    if(NOT pkg_config)
        message(STATUS "Skipped: no pkg-config")
        return()
    endif()
    install_to(${DIRECTORY}/prefix)
    set(ENV{PKG_CONFIG_PATH} ${DIRECTORY}/prefix/share/pkgconfig)
    run(${pkg_config} --print-errors --exact-version=${VERSION} texgen)
    run_for(flags ${pkg_config} --cflags --libs texgen)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    compile(consumer ${without} ${main} ${flags})

elseif(WAY STREQUAL copy)
    file(COPY ${SOURCE}/include DESTINATION ${DIRECTORY})
    compile(consumer ${without} -I ${DIRECTORY}/include ${main})

elseif(WAY STREQUAL single_header)
    run(${CMAKE_COMMAND} -S ${SOURCE} -B ${DIRECTORY}/texgen ${settings} -DBUILD_TESTING=OFF)
    run(${CMAKE_COMMAND} --build ${DIRECTORY}/texgen --target single_header)
    set(folder ${DIRECTORY}/texgen/single_header)
    file(GLOB_RECURSE written RELATIVE ${folder} ${folder}/*)
    if(NOT written STREQUAL "texgen/texgen.hpp")
        message(FATAL_ERROR "written: ${written}")
    endif()
    compile(consumer ${without} -I ${folder} ${main})
    set(units ${SOURCE}/tests/packaging/two_units)
    compile(two_units -DTEXGEN_NO_DISPATCH -I ${folder} ${units}/one.cpp ${units}/two.cpp)

else()
    message(FATAL_ERROR "There is no way ${WAY}")
endif()
