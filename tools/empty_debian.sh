# tools/empty_debian.sh: sourced by tools/fresh_machine and tools/check_packages: an empty Debian in a folder. Needs root,
# debootstrap, and a name space for mounts of its own (unshare --mount).
#   make_machine MACHINE CACHE SUITE MIRROR [PACKAGES]   sets it up with debootstrap (minbase), and mounts /proc and /dev
#   run_in_machine MACHINE HOME COMMAND                  runs a shell command as root, nothing of this machine in its environment
#   close_machine MACHINE                                ends the mounts

make_machine() {
  rm -rf --one-file-system "$1"
  mkdir -p "$1" "$2"
  debootstrap --variant=minbase ${5:+--include="$5"} --cache-dir="$2" "$3" "$1" "$4" >"$2.log" 2>&1 ||
    { tail -n 20 "$2.log" >&2; return 1; }
  cp /etc/resolv.conf /etc/hosts "$1/etc/"
  for file in /etc/apt/apt.conf.d/*proxy*; do [ ! -e "$file" ] || cp "$file" "$1/etc/apt/apt.conf.d/"; done
  mount -t proc proc "$1/proc"
  own_devices "$1/dev"
}

# Devices of the machine's own: what runs there as root must not be able to remove those of this one.
own_devices() {
  mount -t tmpfs -o mode=755 tmpfs "$1"
  mkdir "$1/pts" "$1/shm"
  mount -t devpts -o newinstance,ptmxmode=0666,mode=0620 devpts "$1/pts"
  chmod 1777 "$1/shm"
  for node in null:3 zero:5 full:7 random:8 urandom:9; do mknod -m 666 "$1/${node%:*}" c 1 "${node#*:}"; done
  mknod -m 666 "$1/tty" c 5 0
  ln -s pts/ptmx "$1/ptmx"
  ln -s /proc/self/fd "$1/fd"
  for stream in 0:stdin 1:stdout 2:stderr; do ln -s "/proc/self/fd/${stream%:*}" "$1/${stream#*:}"; done
}

run_in_machine() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME="$2" LANG=C.UTF-8 chroot "$1" sh -c "$3" </dev/null
}

close_machine() {
  umount -R -l "$1/dev" && umount -l "$1/proc"
}
