cmake_minimum_required(VERSION 3.25)

# What a call adds to a program, the kernels of all instruction sets included; README.md says these, in kB. 19 kB of a triangle's
# decide what is in doubt, in vectors and about the tile, so that no triangle costs many times the ordinary one; most of a batch's do.
set(arguments_of_interpolate "const TriangleSetup& setup, FragmentRect rect, Texcoords out")
set(arguments_of_project "const WorldTexgen& texgen, Positions<World> positions, Texcoords out")
set(arguments_of_one "const WorldTexgen& texgen, glm::vec3 position")
set(arguments_of_coverage "const ObjectTexgen& texgen, const Box& box")
set(arguments_of_along "const Segment& segment, std::span<const float> alpha, Texcoords out")
set(arguments_of_footprints "const FootprintSetup& setup, FragmentRect rect, Footprints out")
set(arguments_of_batch "const TriangleBatch& batch, std::span<const FragmentRect> rects, Texcoords out")
set(arguments_of_buffer "const TriangleBatch& batch, std::span<const std::uint32_t> ids, FragmentRect rect, Footprints out")
set(calls
    "68700 interpolate.hpp Work interpolate interpolate(setup, rect, out)"
    "98000 texcoord.hpp void project project(texgen, positions, whole_texture(), out)"
    "8000 texcoord.hpp auto one project(texgen, world_space(position))"
    "34000 coverage.hpp Coverage coverage coverage(texgen, whole_texture(), box)"
    "61000 segment.hpp void along interpolate(segment, alpha, whole_texture(), out)"
    "48000 footprint.hpp bool footprints footprint(setup, rect, out)"
    "330000 batch.hpp void batch interpolate(batch, rects, out)"
    "124000 batch.hpp void buffer footprint(batch, ids, rect, {1024, 1024}, out)")

find_program(size size)
execute_process(COMMAND ${COMPILER} --version OUTPUT_VARIABLE version)
if(NOT size OR NOT version MATCHES "Free Software Foundation")
    message(STATUS "Skipped: it is promised of g++'s code, which `size` counts")
    return()
endif()
# The figures are of the g++ that README.md names; those that came after it add up to 5 % to them.
execute_process(COMMAND ${COMPILER} -dumpversion OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
set(allowed_percent 100)
if(version VERSION_GREATER_EQUAL 13)
    set(allowed_percent 105)
endif()
string(REGEX REPLACE "([^|]+)" "-I\\1" flags "${INCLUDES}")
string(REPLACE "|" ";" flags "${flags}")
foreach(call IN LISTS calls)
    string(REGEX MATCH "^([0-9]+) ([^ ]+) ([^ ]+) ([^ ]+) (.*)$" call "${call}")
    math(EXPR allowed_bytes "${CMAKE_MATCH_1} * ${allowed_percent} / 100")
    set(name ${CMAKE_MATCH_4})
    file(WRITE ${DIRECTORY}/${name}.cpp "#include <texgen/${CMAKE_MATCH_2}>\nusing namespace texgen;\n"
        "${CMAKE_MATCH_3} call(${arguments_of_${name}}) { return ${CMAKE_MATCH_5}; }\n")
    execute_process(COMMAND ${COMPILER} -std=c++20 -O2 -DNDEBUG -c ${flags} ${name}.cpp -o ${name}.o
        WORKING_DIRECTORY ${DIRECTORY} COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${size} -A ${name}.o WORKING_DIRECTORY ${DIRECTORY} OUTPUT_VARIABLE sections
        COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL "\n\\.text[^ ]* +[0-9]+" sections "${sections}")
    list(TRANSFORM sections REPLACE ".* " "")
    list(JOIN sections " + " sum)
    math(EXPR bytes "${sum}")
    message(STATUS "${name}: ${bytes} bytes of code")
    if(bytes GREATER allowed_bytes)
        message(SEND_ERROR "${name} adds more than ${allowed_bytes} bytes.")
    endif()
endforeach()
