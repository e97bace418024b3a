/* Start-up of a Cortex-M4F: vectors, floating-point unit, static data. */
#include <stdint.h>

extern uint32_t _stack_top, _data_source, _data_start, _data_end, _bss_start, _bss_end;

int main(void);
void reset(void);
void fault(void);

__attribute__((section(".vectors"), used)) static const void *const vectors[] = {
    &_stack_top, (const void *)reset, (const void *)fault, (const void *)fault,
    (const void *)fault, (const void *)fault, (const void *)fault,
};

/* Grants access to the floating-point unit (CPACR, coprocessors 10 and 11). */
static void enable_fpu(void) {
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm volatile("dsb\n\tisb" ::: "memory");
}

void reset(void) {
    enable_fpu();
    const uint32_t *source = &_data_source;
    for (uint32_t *word = &_data_start; word < &_data_end; word++) *word = *source++;
    for (uint32_t *word = &_bss_start; word < &_bss_end; word++) *word = 0;
    main();
    for (;;) {
    }
}

__attribute__((weak)) void fault(void) {
    for (;;) {
    }
}
