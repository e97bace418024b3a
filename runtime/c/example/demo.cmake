# Builds demo.c for the emulated Cortex-M4F and runs it with an image:
#   cmake -DIMAGE=elbow.frk -P runtime/c/example/demo.cmake
cmake_minimum_required(VERSION 3.20)
if(NOT IMAGE)
    message(FATAL_ERROR "-DIMAGE=MODEL.frk names the image, before -P")
endif()
get_filename_component(image "${IMAGE}" ABSOLUTE)
get_filename_component(build "demo" ABSOLUTE)
if(NOT EXISTS "${image}")
    message(FATAL_ERROR "there is no image ${image}")
endif()
find_program(QEMU qemu-system-arm)
if(NOT QEMU)
    message(FATAL_ERROR "qemu-system-arm is not installed: tests/setup.sh installs it")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${build} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${build} --target demo.elf OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
# The image lies where the linker script has the flash for it.
execute_process(
    COMMAND ${QEMU} -M mps2-an386 -kernel ${build}/demo.elf -device loader,file=${image},addr=0x200000,force-raw=on
            -display none -serial none -monitor none -chardev stdio,id=out -semihosting-config enable=on,target=native,chardev=out
    RESULT_VARIABLE result)
# The firmware has said why.
if(result)
    message(FATAL_ERROR "nothing was compensated with ${IMAGE}")
endif()
