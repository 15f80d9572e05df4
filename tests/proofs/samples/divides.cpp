// What no_float_in_kernels.sh must find.
float third(float x) {
  return x / 3.0F;
}
