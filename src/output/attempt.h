/* A trial in a child process: what a library does to itself there, it does not do to us. */
#pragma once
#include <petscsys.h>

/* Do the work in a child, without its messages and with 256 MiB and 10 seconds at most. The reason
 * is what the work wrote there; or that it did not
 * come to its end. The work changes nothing here, and must not talk to other ranks. */
void attempt(void (*work)(void *context, char reason[256]), void *context, char reason[256]);
