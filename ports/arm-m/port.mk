# Bare-metal Cortex-M, run by QEMU. Debian: gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-system-arm.
.PHONY: run-arm-m
ARM_M_CC ?= arm-none-eabi-gcc
ARM_M_m4 := -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16
ARM_M_m7 := -mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-sp-d16
ARM_M_SRC := ports/arm-m/main.c ports/null/report.c ports/null/stack.c ports/null/show.c ports/null/scene.c

# sqrtf without errno is one instruction.
$(B)/arm-m/%.elf: $(ARM_M_SRC) $(LIB_SRC) $(wildcard include/*.h src/*.h src/*/*.h ports/null/*.h) ports/arm-m/mps2.ld $(B)/sources
	@mkdir -p $(@D)
	$(ARM_M_CC) $(FLAGS) $(ARM_M_$*) -fno-math-errno -Iports/null -ffunction-sections -fdata-sections -Wl,--gc-sections \
	    -nostartfiles -T ports/arm-m/mps2.ld -Wl,-Map=$@.map -o $@ $(filter %.c,$^)

run-arm-m: $(B)/arm-m/m4.elf $(B)/arm-m/m7.elf
	qemu-system-arm -M mps2-an386 -icount shift=0 -semihosting -nographic -kernel $(B)/arm-m/m4.elf
	qemu-system-arm -M mps2-an500 -icount shift=0 -semihosting -nographic -kernel $(B)/arm-m/m7.elf
