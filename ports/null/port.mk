# The port to copy, and the table of memory in ports/README.md.
NULL_SRC := $(addprefix ports/null/,main.c report.c show.c scene.c bits.c)

$(B)/null: $(call OBJ,$(NULL_SRC)) $(B)/libtyndall.a
	$(CC) $(CFLAGS) -o $@ $^ -lm

$(B)/devices: $(call OBJ,ports/null/devices.c) $(B)/libtyndall.a
	$(CC) $(CFLAGS) -o $@ $^ -lm

-include $(patsubst %.o,%.d,$(call OBJ,$(NULL_SRC) ports/null/devices.c))
