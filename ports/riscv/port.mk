# Bare RISC-V without any libc, run by QEMU. Debian: gcc-riscv64-unknown-elf qemu-system-misc.
.PHONY: run-riscv
RISCV_CC ?= riscv64-unknown-elf-gcc
RISCV_rv32 := -march=rv32imafc -mabi=ilp32f
RISCV_rv64 := -march=rv64imafc -mabi=lp64f -mcmodel=medany
RISCV_SRC := ports/riscv/main.c ports/riscv/libc/libc.c ports/null/report.c ports/null/stack.c ports/null/show.c ports/null/scene.c

# Freestanding, but memcpy of four bytes is to be a move.
$(B)/riscv/%.elf: $(RISCV_SRC) $(LIB_SRC) $(wildcard include/*.h src/*.h src/*/*.h ports/null/*.h ports/riscv/*/*.h) ports/riscv/virt.ld $(B)/sources
	@mkdir -p $(@D)
	$(RISCV_CC) $(FLAGS) $(RISCV_$*) -ffreestanding -fbuiltin -nostdlib -isystem ports/riscv/libc -Iports/null -ffunction-sections \
	    -fdata-sections -Wl,--gc-sections,--no-warn-rwx-segments -T ports/riscv/virt.ld -o $@ $(filter %.c,$^) -lgcc

run-riscv: $(B)/riscv/rv32.elf $(B)/riscv/rv64.elf
	qemu-system-riscv32 -M virt -bios none -icount shift=0 -nographic -kernel $(B)/riscv/rv32.elf
	qemu-system-riscv64 -M virt -bios none -icount shift=0 -nographic -kernel $(B)/riscv/rv64.elf
