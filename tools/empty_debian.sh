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
  mount --rbind /dev "$1/dev"
}

run_in_machine() {
  env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME="$2" LANG=C.UTF-8 chroot "$1" sh -c "$3" </dev/null
}

close_machine() {
  umount -R -l "$1/dev" && umount -l "$1/proc"
}
