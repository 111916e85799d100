// Prints noise_bits() of a process of its own.
#include <iostream>

#include "tests/sensor/noise_bits.h"

int main() {
  const nextview::NoiseBits bits = nextview::noise_bits();
  std::cout << bits.noise << ' ' << bits.libc << '\n';
}
