# A library for the Arduino IDE and for PlatformIO, with the static library for each processor inside:
#   cmake -P runtime/c/arduino/package.cmake                        writes Frikan.zip
#   cmake -DPROCESSORS=cortex-m4 -P runtime/c/arduino/package.cmake   for one processor alone
# The folders have the names by which Arduino finds a precompiled library: the processor, then its floating-point unit and how floats are handed over.
cmake_minimum_required(VERSION 3.20)
if(NOT PROCESSORS)
    set(PROCESSORS cortex-m0plus cortex-m4 cortex-m7 cortex-m33)
endif()
set(cortex-m0plus thumbv6m-none-eabi "")
set(cortex-m4 thumbv7em-none-eabihf /fpv4-sp-d16-hard)
set(cortex-m7 thumbv7em-none-eabihf /fpv5-d16-hard)
set(cortex-m33 thumbv8m.main-none-eabihf /fpv5-sp-d16-hard)

get_filename_component(frikan_c "${CMAKE_CURRENT_LIST_DIR}/.." REALPATH)
get_filename_component(work "frikan-arduino" ABSOLUTE)
set(library "${work}/Frikan")
file(REMOVE_RECURSE "${library}")
file(MAKE_DIRECTORY "${library}/src")
foreach(part library.properties library.json examples)
    file(COPY "${CMAKE_CURRENT_LIST_DIR}/${part}" DESTINATION "${library}")
endforeach()
file(COPY "${frikan_c}/include/frikan.h" DESTINATION "${library}/src")
foreach(processor ${PROCESSORS})
    if(NOT DEFINED ${processor})
        message(FATAL_ERROR "there is no processor ${processor} here")
    endif()
    list(GET ${processor} 0 target)
    list(GET ${processor} 1 unit)
    execute_process(
        COMMAND cargo rustc --quiet --manifest-path ${frikan_c}/Cargo.toml --package frikan-c --profile drive --crate-type staticlib
                --target ${target} --target-dir ${work}/target
        COMMAND_ERROR_IS_FATAL ANY)
    file(COPY "${work}/target/${target}/drive/libfrikan.a" DESTINATION "${library}/src/${processor}${unit}")
endforeach()
execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ../Frikan.zip --format=zip Frikan WORKING_DIRECTORY ${work} COMMAND_ERROR_IS_FATAL ANY)
