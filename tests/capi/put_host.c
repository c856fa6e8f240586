// Text of methods.c on a host.

#include <stdio.h>

#ifdef __cplusplus
extern "C"
#endif
void put(const char *text);

void put(const char *text)
{
    fputs(text, stdout);
}
