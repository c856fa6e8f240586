// How methods.c starts on QEMU's mps2-an386, says what it has to say, and ends: by semihosting, without a C library but what
// compilers call on their own account.

#include <stdint.h>

extern uint32_t stack_top, bss_begin, bss_end;
int main(void);
void put(const char *text);
void reset(void);

static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void put(const char *text)
{
    semihosting(0x04, text);
}

static void leave(uint32_t code)
{
    // The application ended by itself, and with which code.
    const uint32_t why[2] = {0x20026, code};
    semihosting(0x20, why);
    for (;;) {
    }
}

static void fault(void)
{
    put("fault\n");
    leave(3);
}

void reset(void)
{
    // Full access to the floating-point unit.
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;
    __asm__ volatile("dsb\n isb");
    for (uint32_t *word = &bss_begin; word < &bss_end; word++)
        *word = 0;
    leave((uint32_t)main());
}

struct vectors {
    const uint32_t *stack;
    void (*handlers[15])(void);
};

__attribute__((section(".vectors"), used)) static const struct vectors vectors = {
    &stack_top, {reset, fault, fault, fault, fault, fault},
};
